// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "command/context.h"

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace vdb_shell::command
{

/// The part of a word that names a file, with its tokens: "walk.####.obj", or behind "--core=".
struct FileWord {
    std::size_t word = 0;              ///< which one
    std::size_t begin = 0, length = 0; ///< in it
    bool output = false;
};

/// One call of the command that a farm is to do, perhaps with many frames.
struct FarmCall {
    std::string command;
    std::vector<std::string> words; ///< without --frames, and without what tasks say themselves
    std::vector<int> frames;        ///< empty: it runs once
    std::filesystem::path manifest; ///< where those of its parts are joined; absolute
    std::vector<std::string> first_words; ///< as given, of its first frame
    std::vector<FileWord> files;
    std::size_t unnamed_inputs = 0;             ///< that no word names, but a file of options, say
    std::filesystem::path first_input;          ///< of its first frame
    std::vector<std::filesystem::path> outputs; ///< of all frames
    std::string name_of(const FileWord& file) const;
    bool voxels_of_first = false; ///< the first frame of a run chooses the voxels of the others
};

/// A part of a call: the command is run once for it.
struct FarmRun {
    std::size_t call = 0;
    std::size_t part = 0;    ///< counted within the call
    std::vector<int> frames; ///< empty: the call has none
};

/// What one machine does without a break, and what an engine gives out again as a whole.
using FarmTask = std::vector<FarmRun>;

/// What is asked of the engine for each task.
struct FarmLimits {
    /// About a pebibyte, and a year. Engines take whole mebibytes, minutes and seconds, in numbers
    /// that have an end.
    static constexpr double kMostMemoryGib = 1e6, kMostMinutes = 366.0 * 24 * 60;
    int cpus = 4;
    std::optional<double> memory_gib;
    std::optional<double> minutes;
    int at_once = 0; ///< tasks; 0: as the engine likes
    int retries = 2; ///< of a task that was killed
};

struct FarmJob {
    std::string name;
    std::string program;          ///< vdb_shell, as a task's machine knows it
    std::filesystem::path home;   ///< what relative names are relative to; absolute
    std::filesystem::path folder; ///< for messages and manifests of tasks; absolute
    FarmLimits limits;
    std::vector<FarmCall> calls;
    std::vector<FarmTask> tasks;
    std::size_t chunk = 1; ///< steps of a task

    std::size_t steps() const; ///< frames of all calls, and calls without frames
    /// The manifest of a run, in the job's folder.
    std::string manifest_of(const FarmRun& run) const;
};

/// The call, planned with all its frames as the command itself would plan it; `place` begins its
/// errors ("list.txt: line 3"). Inputs that are not there yet are a warning. Throws InvalidOption,
/// WriteError.
FarmCall plan_call(const std::vector<std::string>& words, const std::string& place,
                   const Context& context);

/// Throws InvalidOption where two of them write one file, or one reads what another one writes:
/// nothing says which would be first.
void require_apart(const std::vector<FarmCall>& calls);

/// `chunk` frames of a call, or `chunk` calls without frames, make a task. Throws InvalidOption
/// where parts of a call would choose voxels of their own.
std::vector<FarmTask> tasks_of(const std::vector<FarmCall>& calls, std::size_t chunk);

} // namespace vdb_shell::command
