// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/types.h>

#include <cstdint>
#include <ctime>
#include <deque>
#include <filesystem>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

namespace vdb_shell::command
{

/// A file as it was: its digest is XXH3 of all bytes.
struct FileMark {
    std::string path; ///< of an output relative to the manifest's folder; else as it was given
    std::uint64_t bytes = 0;
    std::string digest;
    bool operator==(const FileMark& other) const;
};

/// Reads the file whole. Throws ReadError.
FileMark mark_of(const std::filesystem::path& file);

/// What one step was made of, and what it made.
struct ManifestEntry {
    std::optional<int> frame;
    int status = 0;
    std::string error;                ///< message of a step that was ended by one
    std::string fingerprint;          ///< of version, command, options and inputs
    std::optional<double> voxel_size; ///< that the sequence had fixed (docs/frames.md)
    std::vector<FileMark> inputs, outputs;
};

/// The file that says which steps are done (--manifest): read when it is made, and written anew, in
/// one piece, after each step. Several processes may share one, each with steps of its own.
class Manifest
{
public:
    /// Throws ReadError for a file that is no manifest, or that of another command.
    Manifest(std::filesystem::path file, std::string command);
    /// The command whose manifest the file is. Throws ReadError.
    static std::string command_in(const std::filesystem::path& file);

    /// Null where nothing is known of it. From any thread.
    std::optional<ManifestEntry> find(std::optional<int> frame) const;
    /// Whether these are the step's outputs, and all of them are as they were written.
    bool outputs_are_there(const ManifestEntry& entry,
                           const std::vector<std::filesystem::path>& outputs) const;
    FileMark mark_output(const std::filesystem::path& file) const;
    /// Notes the step and writes the file. Throws WriteError. From any thread.
    void put(const ManifestEntry& entry);

    /// Notes all steps of the others, which are manifests of the same command; where several know
    /// of a step, the last one holds. Writes the file once.
    void put_all_of(const std::deque<Manifest>& others);
    /// The first of the entry's outputs that is gone, or has another size; empty: none. What is in
    /// it is not read.
    std::string lost_output(const ManifestEntry& entry) const;

private:
    struct Known {
        ManifestEntry entry;
        std::string text; ///< of the entry in the file; empty until it is first written
    };
    using Entries = std::map<std::optional<int>, Known>;
    /// What tells that nobody has replaced the file or written to it: device, inode, bytes, and
    /// when it was written and changed, seconds and nanoseconds.
    using FileState = std::tuple<dev_t, ino_t, off_t, time_t, long, time_t, long>;
    Entries read() const;
    void read_if_changed();
    void write();
    std::optional<FileState> state() const;
    std::string relative(const std::filesystem::path& file) const;
    std::filesystem::path place_of(const FileMark& output) const;

    const std::filesystem::path file_;
    const std::string command_;
    mutable std::mutex mutex_;
    Entries entries_;
    std::optional<FileState> written_; ///< as this object left the file
};

} // namespace vdb_shell::command
