// SPDX-License-Identifier: Apache-2.0

// A job to a list of tasks that a task network in Houdini takes: a work item a task, and one behind
// them that joins. Each command is a list of words that is started without a shell, so nothing in a
// name has a meaning, for Houdini neither: items know only their number.

#include "command/farm_tops.h"

#include "command/frames.h"

#include <nlohmann/json.hpp>

namespace vdb_shell::command
{
namespace
{

using nlohmann::ordered_json;

/// Raised when keys change their meaning.
constexpr int kTopsSchema = 1;

/// --keep-going, since a task is a failure all the same if one frame is, and the others are done by
/// then.
ordered_json words_of(const FarmJob& job, const FarmRun& run)
{
    const FarmCall& call = job.calls[run.call];
    ordered_json words =
        ordered_json::array({job.program, "--threads", std::to_string(job.limits.cpus), "--resume",
                             "--manifest", (job.folder / job.manifest_of(run)).string()});
    if (!run.frames.empty()) {
        words.push_back("--keep-going");
        words.push_back("--frames");
        words.push_back(frames_text(run.frames));
    }
    for (const std::string& word : call.words)
        words.push_back(word);
    return words;
}

/// --expect, since a task that never ran has left no manifest that could be missed.
ordered_json join_words(const FarmJob& job, std::size_t c)
{
    const FarmCall& call = job.calls[c];
    ordered_json words = ordered_json::array({job.program, "join", "-o", call.manifest.string()});
    if (!call.frames.empty())
        words.push_back("--expect=" + frames_text(call.frames));
    for (const FarmTask& task : job.tasks)
        for (const FarmRun& run : task)
            if (run.call == c)
                words.push_back((job.folder / job.manifest_of(run)).string());
    return words;
}

} // namespace

std::string tops_list(const FarmJob& job)
{
    ordered_json json;
    json["schema"] = kTopsSchema;
    json["version"] = VDB_SHELL_VERSION;
    json["name"] = job.name;
    json["home"] = job.home.string();
    json["folder"] = job.folder.string();
    json["cpus"] = job.limits.cpus;
    json["tasks"] = ordered_json::array();
    for (const FarmTask& task : job.tasks) {
        ordered_json commands = ordered_json::array();
        for (const FarmRun& run : task)
            commands.push_back(words_of(job, run));
        json["tasks"].push_back(std::move(commands));
    }
    json["join"] = ordered_json::array();
    for (std::size_t c = 0; c < job.calls.size(); ++c)
        json["join"].push_back(join_words(job, c));
    return json.dump(1) + '\n';
}

} // namespace vdb_shell::command
