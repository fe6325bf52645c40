// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdb_shell/options/name_table.h"

#include "command/exit_code.h"

#include <exception>
#include <memory>
#include <mutex>
#include <optional>
#include <ostream>
#include <string>
#include <vector>

namespace vdb_shell::command
{

class StepProgress;
struct PreparedShell;
class PoseCache;

/// How much is said on standard error; each level says all of those before it.
enum class LogLevel { error, warning, info };
const NameTable<LogLevel>& names(LogLevel);

/// Who reads standard error: a person, or a program that wants one JSON object a line.
enum class MessageFormat { text, json };
const NameTable<MessageFormat>& names(MessageFormat);

/// What the frames of one call have in common.
struct Sequence {
    /// World units. Set by the first frame that chose one, and used by those after it.
    std::optional<double> voxel_size;
    /// The shell that frames of `pose` have in common; under the mutex.
    std::shared_ptr<const PreparedShell> prepared;
    /// What frames of `pose` have in common with their neighbours; under the mutex.
    std::shared_ptr<PoseCache> poses;
    std::mutex mutex;
};

/// What a command gets from whoever runs it. Commands print nowhere else, so that those of several
/// frames can run at once.
struct Context {
    std::ostream& out; ///< figures and findings
    std::ostream& err; ///< all that is said about the work
    LogLevel level = LogLevel::info;
    MessageFormat format = MessageFormat::text;
    std::optional<int> frame;         ///< that is worked on; begins what is said
    std::vector<int> gathered{};      ///< the frames whose files one run was given together
    StepProgress* progress = nullptr; ///< null: not wanted
    Sequence* sequence = nullptr;     ///< null for a call without frames

    /// One line on standard error, if the level wants it.
    void say(LogLevel of, const std::string& text) const;
    /// The same for what was thrown; as JSON with all that is known of it.
    void say(const std::exception& error) const;
    /// The same for a result that is not as it has to be: its file, and what is wrong with it.
    void say_failed(ExitCode status, const std::string& file, const std::string& what) const;
};

} // namespace vdb_shell::command
