// SPDX-License-Identifier: Apache-2.0

// A job to a template of Open Job Description: a step for each call, its tasks the chunks of
// frames, and a step that joins their manifests. Folders are PATH parameters, so that a scheduler
// can carry files to machines and map paths. Commands are started without a shell, so nothing is
// quoted; what would be read as an expression of the template is refused.

#include "command/farm_openjd.h"

#include "vdb_shell/core/error.h"

#include "command/file_plan.h"
#include "command/frames.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

namespace vdb_shell::command
{
namespace
{

namespace fs = std::filesystem;
using nlohmann::ordered_json;

// Limits of the specification (2023-09): elements of a range, and parameters of a job.
constexpr std::size_t kMostInRange = 1024, kMostParameters = 50;
/// Bytes of a file's name, on all file systems of farms.
constexpr std::size_t kLongestName = 255;

/// The folders of a job, a parameter each.
class Folders
{
public:
    /// The parameter of that folder, as an expression.
    std::string use(const fs::path& folder, bool output)
    {
        auto known = std::find_if(folders_.begin(), folders_.end(),
                                  [&](const Folder& f) { return f.path == folder; });
        if (known == folders_.end())
            known = folders_.insert(folders_.end(), Folder{folder, false, false});
        (output ? known->written : known->read) = true;
        return "{{Param.Folder" + std::to_string(known - folders_.begin()) + "}}";
    }

    /// Defaults are relative to the folder of the template. One outside has none, for schedulers
    /// refuse it: it is asked for when the job is handed over.
    void add_to(ordered_json& parameters, const fs::path& home) const
    {
        for (std::size_t i = 0; i < folders_.size(); ++i) {
            const Folder& folder = folders_[i];
            const std::string flow = !folder.written ? "IN" : folder.read ? "INOUT" : "OUT";
            const fs::path relative = folder.path.lexically_relative(home);
            ordered_json parameter{{"name", "Folder" + std::to_string(i)},
                                   {"type", "PATH"},
                                   {"description", folder.path.string()},
                                   {"objectType", "DIRECTORY"},
                                   {"dataFlow", flow}};
            if (!relative.empty() && *relative.begin() != "..")
                parameter["default"] = relative.string();
            parameters.push_back(parameter);
        }
    }

private:
    struct Folder {
        fs::path path;
        bool read, written;
    };
    std::vector<Folder> folders_;
};

/// What the specification calls Cc, and would refuse, and expressions of the template.
const std::string& checked(const std::string& text)
{
    const bool control =
        std::any_of(text.begin(), text.end(), [](unsigned char c) { return c < ' ' || c == 127; });
    if (control || text.find("{{") != std::string::npos)
        throw InvalidOption(
            "\"" + text +
            "\": " + (control ? "a control character" : "\"{{\", which begins an expression,") +
            " has no place in a template of Open Job Description");
    return text;
}

/// Steps are 1-10:2 there.
std::string range_text(std::vector<int> frames)
{
    std::sort(frames.begin(), frames.end());
    std::string text = frames_text(frames);
    std::replace(text.begin(), text.end(), 'x', ':');
    return text;
}

/// Makes the parts of the template from the inside to the outside. Steps come before parameters,
/// for each step adds the folders that it needs.
class Template
{
public:
    Template(const FarmJob& job, const fs::path& file, bool chunking)
        : job_(job), chunking_(chunking), template_folder_(absolute_path(file).parent_path()),
          tasks_folder_(folders_.use(checked(job.folder.string()), true))
    {
        // Read as well: --resume looks at what an earlier attempt has noted, and the join at what
        // all tasks have.
        folders_.use(job.folder, false);
    }

    ordered_json make()
    {
        ordered_json steps = ordered_json::array();
        for (std::size_t c = 0; c < job_.calls.size(); ++c) {
            steps.push_back(call_step(c));
            // A call without frames is one task, whose manifest says everything already.
            if (!job_.calls[c].frames.empty())
                steps.push_back(join_step(c));
        }
        ordered_json json;
        json["specificationVersion"] = "jobtemplate-2023-09";
        if (chunking_)
            json["extensions"] = ordered_json::array({"TASK_CHUNKING"});
        json["name"] = job_.name;
        json["description"] = std::to_string(job_.steps()) +
                              " frames or runs, written by vdb_shell " VDB_SHELL_VERSION;
        json["parameterDefinitions"] = parameters();
        json["jobEnvironments"] = ordered_json::array({folder_environment()});
        json["steps"] = std::move(steps);
        return json;
    }

private:
    /// Manifests need it to be there.
    ordered_json folder_environment() const
    {
        const ordered_json make{{"command", "mkdir"},
                                {"args", ordered_json::array({"-p", tasks_folder_})}};
        const ordered_json actions{{"onEnter", make}};
        const ordered_json script{{"actions", actions}};
        return {{"name", "folder"}, {"script", script}};
    }

    ordered_json parameters() const
    {
        ordered_json all = ordered_json::array();
        all.push_back({{"name", "Program"},
                       {"type", "STRING"},
                       {"description", "vdb_shell, as the workers know it"},
                       {"default", checked(job_.program)}});
        // The scheduler parts the frames, so they are a parameter of the job, which whoever submits
        // it can change.
        if (chunking_)
            all.push_back({{"name", "Frames"},
                           {"type", "STRING"},
                           {"default", range_text(job_.calls.front().frames)}});
        folders_.add_to(all, template_folder_);
        if (all.size() > kMostParameters)
            throw InvalidOption("the calls have files in " + std::to_string(all.size() - 1) +
                                " folders; a template has at most " +
                                std::to_string(kMostParameters) + " parameters: make several jobs");
        return all;
    }

    std::string in_folder(const fs::path& path, bool output)
    {
        // The folder is an expression, which the worker's own path replaces; the name behind it
        // stays, with its frame token.
        const fs::path whole = (job_.home / path).lexically_normal();
        return folders_.use(checked(whole.parent_path().string()), output) + "/" +
               checked(whole.filename().string());
    }

    std::string step_name(std::size_t call) const { return "call-" + std::to_string(call); }

    std::vector<std::string> words_of(const FarmCall& call)
    {
        std::vector<std::string> words = call.words;
        // A folder becomes a parameter only if a word of the call shows it.
        if (call.unnamed_inputs > 0)
            throw InvalidOption("an input is named by no word of the call, but by a file of "
                                "options: a worker would not get it; name it in the call");
        // Before expressions are put in, which have the braces that are refused here.
        for (std::string& word : words)
            checked(word);
        for (const FileWord& file : call.files)
            words[file.word].replace(file.begin, file.length,
                                     in_folder(call.name_of(file), file.output));
        return words;
    }

    /// What starts a command, and how it is ended.
    ordered_json run_action(const ordered_json& args) const
    {
        ordered_json run{{"command", "{{Param.Program}}"}, {"args", args}};
        constexpr double kSeconds = 60;
        if (job_.limits.minutes)
            run["timeout"] = std::lround(std::ceil(*job_.limits.minutes * kSeconds));
        // vdb_shell removes its temporaries on SIGTERM, within half a second.
        run["cancelation"] = {{"mode", "NOTIFY_THEN_TERMINATE"}, {"notifyPeriodInSeconds", 10}};
        const ordered_json actions{{"onRun", run}};
        return {{"actions", actions}};
    }

    /// The chunks of a call, each as a text of frames.
    ordered_json parts_of(std::size_t call) const
    {
        ordered_json parts = ordered_json::array();
        for (const FarmTask& task : job_.tasks)
            for (const FarmRun& run : task)
                if (run.call == call)
                    parts.push_back(frames_text(run.frames));
        if (parts.size() > kMostInRange)
            throw InvalidOption("a call has " + std::to_string(parts.size()) +
                                " tasks; a template has at most " + std::to_string(kMostInRange) +
                                " (--chunk, or --task-chunking)");
        return parts;
    }

    /// Manifests of tasks are named by their frames, which have no pattern where somebody picked
    /// them. A worker would find that out, a thousand times.
    void require_names(std::size_t call) const
    {
        for (const FarmTask& task : job_.tasks)
            for (const FarmRun& run : task) {
                if (run.call != call)
                    continue;
                // How a scheduler parts them is up to it: the parts here stand for those.
                const std::string frames = frames_text(run.frames),
                                  name = std::to_string(call) + "-" + frames + ".json";
                if (name.size() > kLongestName)
                    throw InvalidOption("a task of the frames " + frames.substr(0, 40) +
                                        "... would have a manifest whose name has " +
                                        std::to_string(name.size()) + " bytes, over the limit of " +
                                        std::to_string(kLongestName) + ": give a smaller --chunk");
            }
    }

    ordered_json parameter_space(std::size_t call) const
    {
        ordered_json frames{{"name", "Frames"}};
        if (chunking_) {
            frames["type"] = "CHUNK[INT]";
            frames["range"] = "{{Param.Frames}}";
            // Every frame is a run of its own, so those of a chunk need not follow each other.
            frames["chunks"] = {{"defaultTaskCount", job_.chunk},
                                {"rangeConstraint", "NONCONTIGUOUS"}};
        } else {
            // Without the extension a task has one value. A text like 1-9x2 lets it hold a whole
            // chunk.
            frames["type"] = "STRING";
            frames["range"] = parts_of(call);
        }
        return {{"taskParameterDefinitions", ordered_json::array({frames})}};
    }

    ordered_json requirements() const
    {
        constexpr double kMibPerGib = 1024;
        ordered_json amounts = ordered_json::array();
        // Names of the specification, which counts memory in MiB.
        amounts.push_back({{"name", "amount.worker.vcpu"}, {"min", job_.limits.cpus}});
        if (job_.limits.memory_gib)
            amounts.push_back({{"name", "amount.worker.memory"},
                               {"min", std::ceil(*job_.limits.memory_gib * kMibPerGib)}});
        return {{"amounts", amounts}};
    }

    ordered_json call_step(std::size_t c)
    {
        const FarmCall& call = job_.calls[c];
        const bool frames = !call.frames.empty();
        if (frames)
            require_names(c);
        // By its frames, for a template does not know the number of a task.
        const std::string part = tasks_folder_ + "/" + std::to_string(c) + "-" +
                                 (frames ? "{{Task.Param.Frames}}" : "0") + ".json";
        ordered_json args = ordered_json::array(
            {"--threads", std::to_string(job_.limits.cpus), "--resume", "--manifest", part});
        if (frames)
            for (const char* word : {"--keep-going", "--frames", "{{Task.Param.Frames}}"})
                args.push_back(word);
        for (const std::string& word : words_of(call))
            args.push_back(word);
        ordered_json step{{"name", step_name(c)}, {"hostRequirements", requirements()}};
        if (frames)
            step["parameterSpace"] = parameter_space(c);
        step["script"] = run_action(args);
        return step;
    }

    ordered_json join_step(std::size_t c)
    {
        const FarmCall& call = job_.calls[c];
        ordered_json args = ordered_json::array({"join", "-o", in_folder(call.manifest, true)});
        args.push_back(chunking_ ? std::string("--expect={{Param.Frames}}")
                                 : "--expect=" + frames_text(call.frames));
        // How the scheduler will part the frames is not known, so all manifests of the folder are
        // joined.
        if (chunking_)
            args.push_back(tasks_folder_);
        else
            for (const ordered_json& frames : parts_of(c))
                args.push_back(tasks_folder_ + "/" + std::to_string(c) + "-" +
                               frames.get<std::string>() + ".json");
        ordered_json dependencies = ordered_json::array();
        dependencies.push_back({{"dependsOn", step_name(c)}});
        return {{"name", "join-" + std::to_string(c)},
                {"dependencies", dependencies},
                {"script", run_action(args)}};
    }

    const FarmJob& job_;
    const bool chunking_;
    const fs::path template_folder_;
    Folders folders_;
    const std::string tasks_folder_;
};

} // namespace

std::string openjd_template(const FarmJob& job, const fs::path& file, bool task_chunking)
{
    if (task_chunking && (job.calls.size() > 1 || job.calls.front().frames.empty()))
        throw InvalidOption("--task-chunking takes one call with --frames");
    return Template(job, file, task_chunking).make().dump(2) + '\n';
}

} // namespace vdb_shell::command
