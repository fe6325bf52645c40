// SPDX-License-Identifier: Apache-2.0

// From the words of a call to the tasks of a farm. A call is planned here as the command would plan
// it, so what it would refuse is refused before there is a job. What tasks have to say for
// themselves (--frames, --manifest, --resume, --keep-going) is taken out of its words: so a call
// that was tried on one machine can be given to a farm as it stands.

#include "command/farm_job.h"

#include "vdb_shell/core/error.h"
#include "vdb_shell/core/words.h"

#include "command/call.h"
#include "command/file_plan.h"
#include "command/frames.h"
#include "command/sequence.h"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <array>
#include <map>
#include <utility>

namespace vdb_shell::command
{
namespace
{

namespace fs = std::filesystem;

/// Commands that make or test files, which is what farms are for.
constexpr std::array<const char*, 9> kCommands{"build",   "pose",    "volumes", "deform", "map",
                                               "convert", "inspect", "check",   "repair"};

bool is_flag(const std::string& word, const std::string& flag)
{
    return word == flag || word.rfind(flag + "=", 0) == 0;
}

/// The words that every task has in common.
std::vector<std::string> shared_words(const std::vector<std::string>& words)
{
    std::vector<std::string> shared;
    for (std::size_t i = 0; i < words.size(); ++i) {
        const std::string& word = words[i];
        // Flags that every task says anyway, or that would contradict what it says.
        const bool alone = is_flag(word, "--resume") || is_flag(word, "--keep-going") ||
                           word == "--no-resume" || word == "--no-keep-going";
        const bool valued = is_flag(word, "--frames") || is_flag(word, "--manifest");
        if (valued && word.find('=') == std::string::npos)
            ++i; // its value
        if (!alone && !valued)
            shared.push_back(word);
    }
    return shared;
}

/// What a call may not have on a farm, though it may have it here.
void require_for_farm(const Call& call, const std::vector<std::string>& words)
{
    const std::string name = call.name();
    if (std::find(kCommands.begin(), kCommands.end(), name) == kCommands.end()) {
        std::string known;
        for (const char* command : kCommands)
            known += std::string(known.empty() ? "" : ", ") + command;
        throw InvalidOption("`" + name + "` is not for a farm; those are " + known);
    }
    const GlobalArguments& global = call.global();
    if (global.dry_run)
        throw InvalidOption("--dry-run stands before --, beside farm");
    // Two places for one number could contradict each other, and the engine only knows of its own.
    if (global.threads > 0)
        throw InvalidOption("--threads is said to the tasks by farm; give it --cpus");
    for (const std::string& word : words)
        if (word.find_first_of("\n\r") != std::string::npos)
            throw InvalidOption("\"" + word.substr(0, word.find_first_of("\n\r")) +
                                "...\": a line break in a name or value has no place in a job");
}

/// Without --voxel-size a run takes that of its first frame, and each task has a first one.
bool takes_voxels_of_first(const Call& call, const FilePlan& plan)
{
    const bool level_set =
        !plan.inputs().empty() && lower_case_extension(plan.inputs().front().path) == ".vdb";
    return call.name() == "build" && !level_set && call.value_of("--voxel-size").empty();
}

/// The file of the list that the word names, whole, behind "--flag=" or before ":GRID".
std::optional<FileWord> file_word(const std::string& word, std::optional<int> frame,
                                  const std::vector<fs::path>& files)
{
    const std::size_t behind_flag = word.rfind("--", 0) == 0 ? word.find('=') + 1 : 0;
    // The whole word first, for a colon can be a part of a file's name.
    for (const std::size_t length : {word.size(), word.rfind(':')}) {
        if (length == std::string::npos || length <= behind_flag)
            continue;
        const std::string name = word.substr(behind_flag, length - behind_flag);
        const fs::path path = frame ? with_frame(name, *frame) : name;
        if (std::find(files.begin(), files.end(), path) != files.end())
            return FileWord{0, behind_flag, length - behind_flag, false};
    }
    return std::nullopt;
}

/// Notes which words name files of the first frame, in the form that they have with tokens: engines
/// that carry files to workers need to know them.
void take_files(FarmCall& farm, const std::vector<Step>& steps)
{
    for (const Step& step : steps)
        farm.outputs.insert(farm.outputs.end(), step.outputs.begin(), step.outputs.end());
    const Step& first = steps.front();
    std::vector<fs::path> inputs = first.inputs;
    // Those that are not there yet as well: a job before this one may make them, and a worker has
    // to get them.
    inputs.insert(inputs.end(), first.missing.begin(), first.missing.end());
    if (!inputs.empty())
        farm.first_input = inputs.front();
    std::size_t named = 0;
    for (std::size_t w = 0; w < farm.words.size(); ++w) {
        std::optional<FileWord> file = file_word(farm.words[w], first.frame, inputs);
        named += file ? 1 : 0;
        // Inputs first: no file is both, for the plan has refused that.
        if (!file && (file = file_word(farm.words[w], first.frame, first.outputs)))
            file->output = true;
        if (file) {
            file->word = w;
            farm.files.push_back(*file);
        }
    }
    // A file of options can name files of its own, which no word of the call shows.
    farm.unnamed_inputs = inputs.size() - std::min(inputs.size(), named);
}

void warn_of_missing(const std::vector<Step>& steps, const std::string& place,
                     const Context& context)
{
    std::size_t missing = 0;
    const Step* first = nullptr;
    for (const Step& step : steps) {
        missing += step.missing.empty() ? 0 : 1;
        first = first || step.missing.empty() ? first : &step;
    }
    if (first)
        context.say(LogLevel::warning,
                    place + "warning: inputs that are not there yet: " + std::to_string(missing) +
                        " of " + std::to_string(steps.size()) + ", the first of them " +
                        first->missing.front().string());
}

FarmCall plan_words(const std::vector<std::string>& words, const std::string& place,
                    const Context& context)
{
    Call call;
    call.parse(words);
    require_for_farm(call, words);
    GlobalArguments global = call.global();
    FarmCall farm;
    farm.command = call.name();
    farm.words = shared_words(words);
    if (!global.manifest.empty())
        farm.manifest = absolute_path(global.manifest);
    global.resume = global.keep_going = true; // as tasks will have it
    const std::vector<Step> steps = plan_steps(words, global, context);
    // The words of one frame can be planned and estimated by themselves; those with tokens cannot.
    farm.first_words = steps.front().words;
    Call first;
    first.parse(farm.first_words);
    const FilePlan plan = first.plan();
    if (plan.reads_standard_input())
        throw InvalidOption("-: a task has no standard input");
    for (const Step& step : steps)
        if (step.frame)
            farm.frames.push_back(*step.frame);
    farm.voxels_of_first = !farm.frames.empty() && takes_voxels_of_first(first, plan);
    take_files(farm, steps);
    warn_of_missing(steps, place, context);
    return farm;
}

/// Of all frames.
std::vector<std::string> inputs_of(const FarmCall& call)
{
    std::vector<std::string> names;
    for (const FileWord& file : call.files) {
        if (file.output)
            continue;
        if (call.frames.empty())
            names.push_back(call.name_of(file));
        for (const int frame : call.frames)
            names.push_back(with_frame(call.name_of(file), frame));
    }
    return names;
}

/// A file however its path is written.
std::string identity_of(const fs::path& path)
{
    std::error_code unknown;
    const fs::path real = fs::weakly_canonical(path, unknown);
    return unknown ? absolute_path(path).string() : real.string();
}

} // namespace

std::string FarmCall::name_of(const FileWord& file) const
{
    return words[file.word].substr(file.begin, file.length);
}

std::size_t FarmJob::steps() const
{
    std::size_t count = 0;
    for (const FarmCall& call : calls)
        count += std::max<std::size_t>(call.frames.size(), 1);
    return count;
}

std::string FarmJob::manifest_of(const FarmRun& run) const
{
    return std::to_string(run.call) + "-" + std::to_string(run.part) + ".json";
}

FarmCall plan_call(const std::vector<std::string>& words, const std::string& place,
                   const Context& context)
{
    const std::string begin = place.empty() ? "" : place + ": ";
    // What is thrown keeps its kind, by which the status of the command goes, and gets the line of
    // the list.
    try {
        return plan_words(words, begin, context);
    } catch (const CLI::ParseError& error) {
        throw InvalidOption(begin + "the call: " +
                            (error.get_exit_code() == 0 ? "--help and --version print, and leave "
                                                          "nothing for a farm to do"
                                                        : error.what()));
    } catch (const InvalidOption& error) {
        throw InvalidOption(begin + "the call: " + error.what());
    } catch (const WriteError& error) {
        throw WriteError(begin + "the call: " + error.what());
    }
}

void require_apart(const std::vector<FarmCall>& calls)
{
    std::map<std::string, std::size_t> writers;
    const auto name = [](std::size_t call) { return "call " + std::to_string(call + 1); };
    for (std::size_t i = 0; i < calls.size(); ++i) {
        std::vector<fs::path> written = calls[i].outputs;
        if (!calls[i].manifest.empty())
            written.push_back(calls[i].manifest);
        for (const fs::path& output : written) {
            const auto [other, added] = writers.emplace(identity_of(output), i);
            // Frames of one call have been held against each other by plan_steps.
            if (!added && other->second != i)
                throw InvalidOption(output.string() + ": would be written by " +
                                    name(other->second) + " and by " + name(i));
        }
    }
    for (std::size_t i = 0; i < calls.size(); ++i)
        for (const std::string& input : inputs_of(calls[i])) {
            const auto writer = writers.find(identity_of(input));
            if (writer != writers.end() && writer->second != i)
                throw InvalidOption(input + ": is written by " + name(writer->second) +
                                    " and read by " + name(i) +
                                    ", and nothing says which is first; make two jobs");
        }
}

std::vector<FarmTask> tasks_of(const std::vector<FarmCall>& calls, std::size_t chunk)
{
    // Calls without frames share a task, as many as `chunk`; a call with frames has tasks of its
    // own, for --frames belongs to one run of the command.
    std::vector<FarmTask> tasks;
    bool open = false; // whether the last one takes calls without frames
    for (std::size_t c = 0; c < calls.size(); ++c) {
        const std::vector<int>& frames = calls[c].frames;
        if (frames.empty()) {
            if (!open || tasks.back().size() >= chunk)
                tasks.emplace_back();
            tasks.back().push_back({c, 0, {}});
            open = true;
            continue;
        }
        if (calls[c].voxels_of_first && frames.size() > chunk)
            throw InvalidOption(
                "call " + std::to_string(c + 1) +
                ": tasks with frames of their own would each choose a voxel size by --resolution; "
                "give --voxel-size (`vdb_shell estimate` prints the one that a surface has)");
        for (std::size_t begin = 0; begin < frames.size(); begin += chunk) {
            const std::size_t end = std::min(begin + chunk, frames.size());
            tasks.push_back(
                {{c,
                  begin / chunk,
                  {frames.begin() + std::ptrdiff_t(begin), frames.begin() + std::ptrdiff_t(end)}}});
        }
        open = false;
    }
    return tasks;
}

} // namespace vdb_shell::command
