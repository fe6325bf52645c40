// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/stat.h>

#include <filesystem>
#include <string>
#include <system_error>

namespace vdb_shell
{

/// A name in the table that a signal handler reads, for as long as this object lives; the file of
/// that name is removed with it.
class TemporaryName
{
public:
    /// `kind` is "tmp" for new files and "old" for replaced ones.
    TemporaryName(const std::filesystem::path& folder, const char* kind,
                  const std::filesystem::path& target);
    ~TemporaryName();
    TemporaryName(const TemporaryName&) = delete;
    TemporaryName& operator=(const TemporaryName&) = delete;
    const std::filesystem::path& path() const { return path_; }

private:
    std::filesystem::path path_;
    std::size_t slot_;
};

/// An open file that is closed with this object.
class Descriptor
{
public:
    explicit Descriptor(int number = -1) : number_(number) {}
    ~Descriptor();
    Descriptor(const Descriptor&) = delete;
    Descriptor& operator=(const Descriptor&) = delete;
    int number() const { return number_; }
    void reset(int number);

private:
    int number_;
};

/// A new empty file under a name that nobody can guess, locked so that others see that it is in
/// use. Nothing that stands there already is opened, no link followed.
class TemporaryFile
{
public:
    /// Throws WriteError that names `target`. `mode` is subject to the umask.
    TemporaryFile(const std::filesystem::path& folder, const std::filesystem::path& target,
                  mode_t mode);
    const std::filesystem::path& path() const { return name_.path(); }
    int descriptor() const { return file_.number(); }
    /// False where another file stands under its name by now.
    bool still_there() const;

private:
    TemporaryName name_;
    Descriptor file_;
};

/// What is to be said where the system's folder for temporary files is none.
std::string no_temporary_folder(const std::error_code& why);

/// Removes what processes that were killed have left in the folder: files with names of ours that
/// nobody has locked.
void remove_leftovers(const std::filesystem::path& folder);

/// While one lives, files are being put in their places and no handler may end the process.
class CommitGuard
{
public:
    CommitGuard();
    ~CommitGuard();
    CommitGuard(const CommitGuard&) = delete;
    CommitGuard& operator=(const CommitGuard&) = delete;
};

} // namespace vdb_shell
