// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "command/context.h"
#include "command/file_plan.h"
#include "command/progress.h"

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

namespace CLI
{
class ParseError;
}

namespace vdb_shell::command
{

struct BuildArguments;
struct DeformArguments;
struct PoseArguments;

/// What can be said beside any command.
struct GlobalArguments {
    int threads = 0;
    std::string frames;
    bool dry_run = false;
    bool keep_going = false;
    bool resume = false;
    std::filesystem::path manifest;
    int frames_at_once = 0; ///< 0: chosen by the size of the inputs
    ProgressStyle progress = ProgressStyle::none;
    LogLevel log_level = LogLevel::info;
    MessageFormat errors = MessageFormat::text;
};

/// The words of a command line, without the program's name, as the parser wants them: joined to its
/// flag is a value that begins with a minus (--frames -3-10), and one that may be left out
/// (--progress json).
std::vector<std::string> words_of(const std::vector<std::string>& given);

/// One command with its options, from its words; each frame of a sequence has its own.
class Call
{
public:
    /// `only`: the command that is known to be given. The parser of all commands takes milliseconds
    /// to make, and of one a fraction of that. Empty: any can be.
    explicit Call(const std::string& only = "");
    ~Call();
    Call(const Call&) = delete;
    Call& operator=(const Call&) = delete;

    /// Parses all words, and sets the options that stand beside the command. Throws
    /// CLI::ParseError, also for --help, and InvalidOption.
    void parse(const std::vector<std::string>& words);
    /// Prints what the parser has to say; the status is ours.
    int end(const CLI::ParseError& error) const;
    const GlobalArguments& global() const;
    /// The command's.
    std::string name() const;
    /// Whether the command takes all frames in one run.
    bool gathers_frames() const;
    /// Sets the command's options, and refuses all that can be refused before anything is read.
    FilePlan plan();
    /// After plan(): the command and all that it was told, with names of files but without their
    /// folders. Equal texts and equal inputs give equal outputs.
    std::string options_text() const;
    /// After plan(): the value of the command's option with that flag; empty where it is unset.
    std::string value_of(const std::string& flag) const;
    /// After plan() of a call of that command.
    const BuildArguments& build_arguments() const;
    const PoseArguments& pose_arguments() const;
    const DeformArguments& deform_arguments() const;
    /// After plan().
    int run(Context& context);

private:
    struct Parts;
    std::unique_ptr<Parts> parts_;
};

} // namespace vdb_shell::command
