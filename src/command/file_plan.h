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
    /// its reader; no path at all is passed over, and standard input can be one of them.
    void add_input(const std::filesystem::path& path);

    /// Throws InvalidOption for a file that is an input, another output, or what standard output or
    /// standard error go to; WriteError where no file can be written or an existing one is kept.
    void add_output(const std::filesystem::path& path);

    struct Identity {
        std::uint64_t device = 0, inode = 0;
        std::string name; ///< in the folder of that inode; empty: the inode is the file's
        bool operator==(const Identity& other) const;
        bool operator<(const Identity& other) const;
    };
    struct Entry {
        std::filesystem::path path;
        Identity identity;
        bool special = false; ///< of an output: a device or a fifo
    };
    Existing existing() const { return existing_; }
    const std::vector<Entry>& inputs() const { return inputs_; }
    const std::vector<Entry>& outputs() const { return outputs_; }
    bool reads_standard_input() const { return standard_input_; }
    /// Inputs that are not there.
    const std::vector<std::filesystem::path>& missing() const { return missing_; }

private:
    static std::optional<Identity> identity_of(const std::filesystem::path& path);
    static const Entry* find(const std::vector<Entry>& entries, const Identity& identity);

    Existing existing_;
    std::vector<Entry> inputs_, outputs_;
    std::vector<std::filesystem::path> missing_;
    bool standard_input_ = false;
};

/// Of a command that only reads.
FilePlan plan_reading(const std::filesystem::path& file);

/// Throws InvalidOption where the path has not this extension: ".vdb".
void require_extension(const std::filesystem::path& path, const std::string& extension);

/// Whole, without "." and "..". Throws ReadError where the folder of the call, from which relative
/// paths are meant, is gone.
std::filesystem::path absolute_path(const std::filesystem::path& path);
std::filesystem::path current_folder();

/// "-", standard input in the place of a file.
bool is_standard_input(const std::filesystem::path& path);

/// True for "-" and for the names that the system has for standard output.
bool is_standard_output(const std::filesystem::path& path);

/// The option that keeps files that are there.
Option no_clobber_option(bool& keep);
Existing existing_files(bool keep);

} // namespace vdb_shell::command
