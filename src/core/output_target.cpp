// SPDX-License-Identifier: Apache-2.0

// Takes a path that an output was given; leaves the place where its file really goes, or the reason
// why none can. Links are followed here and once, because a rename would replace the link. What a
// link leads to is asked of the system first: links in /proc name pipes, whose text is no path.

#include "core/output_target.h"

#include "core/temporary_file.h"
#include "vdb_shell/core/error.h"

#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <system_error>

namespace vdb_shell
{
namespace
{

namespace fs = std::filesystem;

/// As many links as Linux itself follows in one path.
constexpr int kMostLinks = 40;

fs::path without_links(const fs::path& given)
{
    fs::path path = given;
    std::error_code error;
    for (int links = 0; fs::is_symlink(fs::symlink_status(path, error)); ++links) {
        if (links == kMostLinks)
            refuse_output(given, "its links lead round in a circle, or are more than 40");
        const fs::path next = fs::read_symlink(path, error);
        if (error)
            refuse_output(given, error.message());
        // A relative link counts from the folder that it stands in; an absolute one replaces all.
        path = path.parent_path() / next;
    }
    return path;
}

/// The superuser may write any file, but whoever took all permissions to write away meant something
/// by it.
bool read_only(const fs::path& path, const struct stat& status)
{
    return (status.st_mode & (S_IWUSR | S_IWGRP | S_IWOTH)) == 0 ||
           ::access(path.c_str(), W_OK) != 0;
}

void require_file_that_may_be_written(const OutputTarget& target)
{
    const mode_t mode = target.existing->st_mode;
    if (S_ISDIR(mode))
        refuse_output(target.given, "it is a folder");
    if (S_ISSOCK(mode))
        refuse_output(target.given, "it is a socket");
    if (S_ISBLK(mode))
        refuse_output(target.given, "it is a block device");
    if (read_only(target.path, *target.existing))
        refuse_output(target.given, "it is read-only");
}

void require_folder(const OutputTarget& target)
{
    std::error_code error;
    const fs::path folder = target.folder();
    if (!fs::is_directory(folder, error))
        refuse_output(target.given, "its folder does not exist");
    // An early test, to save the user a long run; the write itself is what decides.
    if (::access(folder.c_str(), W_OK | X_OK) != 0)
        refuse_output(target.given, std::strerror(errno));
}

/// What goes into a device or a fifo is put together there.
void require_temporary_folder(const OutputTarget& target)
{
    std::error_code none;
    const fs::path folder = fs::temp_directory_path(none);
    if (none)
        refuse_output(target.given, no_temporary_folder(none));
    if (::access(folder.c_str(), W_OK | X_OK) != 0)
        refuse_output(target.given, no_temporary_folder({errno, std::generic_category()}));
}

/// The temporary has another name, so only the rename after the work would find out.
void require_short_name(const OutputTarget& target)
{
    // Not known (-1) where the file system has no limit, or does not say.
    const long most = ::pathconf(target.folder().c_str(), _PC_NAME_MAX);
    const std::size_t size = target.path.filename().native().size();
    if (most > 0 && size > std::size_t(most))
        refuse_output(target.given, "its name has " + std::to_string(size) +
                                        " bytes, and its folder's limit is " +
                                        std::to_string(most));
}

} // namespace

fs::path OutputTarget::folder() const
{
    return path.has_parent_path() ? path.parent_path() : fs::path(".");
}

OutputTarget find_output_target(const fs::path& path)
{
    if (path.filename().empty())
        refuse_output(path, "it names no file");
    OutputTarget target{path, path, false, std::nullopt};
    struct stat status {
    };
    if (::stat(path.c_str(), &status) == 0) {
        target.existing = status;
        target.special = S_ISCHR(status.st_mode) || S_ISFIFO(status.st_mode);
    }
    if (!target.special)
        target.path = without_links(path);
    if (target.existing)
        require_file_that_may_be_written(target);
    if (target.special) {
        require_temporary_folder(target);
    } else {
        require_folder(target);
        require_short_name(target);
    }
    return target;
}

void refuse_output(const fs::path& path, const std::string& why)
{
    throw WriteError(path.string() + ": cannot be written: " + why);
}

} // namespace vdb_shell
