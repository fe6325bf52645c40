// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdb_shell/core/output_set.h"
#include "vdb_shell/options/option.h"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace vdb_shell::command
{

/// All files of one call, made before any of them is read. Files are told apart by device and
/// inode, so that links and other ways to write a path do not hide that two are one; a file that is
/// not there yet by its folder and its name.
class FilePlan
{
public:
    explicit FilePlan(Existing existing) : existing_(existing) {}

    /// Throws InvalidOption where an output would overwrite it. One that is not there is left to
    /// its reader.
    void add_input(const std::filesystem::path& path);

    /// Throws InvalidOption for a file that is an input, another output, or what standard output or
    /// standard error go to; WriteError where no file can be written or an existing one is kept.
    void add_output(const std::filesystem::path& path);

private:
    struct Identity {
        std::uint64_t device = 0, inode = 0;
        std::string name; ///< in the folder of that inode; empty: the inode is the file's
        bool operator==(const Identity& other) const;
    };
    struct Entry {
        std::filesystem::path path;
        Identity identity;
    };
    static std::optional<Identity> identity_of(const std::filesystem::path& path);
    static const Entry* find(const std::vector<Entry>& entries, const Identity& identity);

    Existing existing_;
    std::vector<Entry> inputs_, outputs_;
};

/// True for "-" and for the names that the system has for standard output.
bool is_standard_output(const std::filesystem::path& path);

/// The option that keeps files that are there.
Option no_clobber_option(bool& keep);
Existing existing_files(bool keep);

} // namespace vdb_shell::command
