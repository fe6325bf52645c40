// SPDX-License-Identifier: Apache-2.0

// The command `farm`: a call with frames, or a list of calls, in; a job for the engine of a farm
// out. It runs nothing itself. All that can be refused is refused before the job is written, for on
// a farm an error comes hours later, a thousand times, and to another person.

#include "command/farm_command.h"

#include "vdb_shell/core/error.h"
#include "vdb_shell/core/output_set.h"
#include "vdb_shell/fill/fill_core.h"

#include "command/call.h"
#include "command/exit_code.h"
#include "command/farm_limits.h"
#include "command/farm_openjd.h"
#include "command/farm_slurm.h"
#include "command/farm_tops.h"
#include "command/shell_words.h"
#include "command/signals.h"
#include "core/text_stream.h"
#include "fill/outside_program.h"
#include "options/shown_text.h"

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cctype>
#include <fstream>
#include <ostream>

namespace vdb_shell::command
{
namespace
{

namespace fs = std::filesystem;

/// Slurm refuses larger arrays unless it is set up otherwise (MaxArraySize).
constexpr std::size_t kMostTasks = 1000;

OptionList job_options(FarmArguments& a)
{
    Option job = option("", a.job, "--output", "The job to write").with_names({"-o"});
    Option engine = option("", a.engine, "--engine", "What the job is for");
    job.required = engine.required = true;
    return {engine,
            job,
            no_clobber_option(a.no_clobber),
            option("", a.calls, "--calls",
                   "File with one call a line, in place of the one behind --: words as for a "
                   "shell, or a JSON array of them; a line that begins with # is a comment"),
            option("", a.name, "--name",
                   "Of the job: letters, digits, . _ -; without it that of the file"),
            option("", a.folder, "--directory",
                   "Folder for messages and manifests of tasks; without it the job's name without "
                   "its extension, and .tasks"),
            option("", a.program, "--program",
                   "vdb_shell, as the machines of the farm know it; without it this very file for "
                   "Slurm, and else the one in the folders of PATH"),
            option("", a.submit, "--submit", "Hand it over as well; status 8 where no Slurm is")
                .needing("--engine slurm"),
            option("", a.task_chunking, "--task-chunking",
                   "Let the scheduler part the frames (extension TASK_CHUNKING); --chunk is what "
                   "it begins with")
                .needing("--engine openjd")};
}

OptionList task_options(FarmArguments& a)
{
    FarmLimits& limits = a.limits;
    return {option("", a.chunk, "--chunk",
                   "Frames, or calls without frames, of a task; 0 is as many as take ten minutes, "
                   "and not more than 1000 tasks")
                .in(Unit::count)
                .within(at_least(0)),
            option("", limits.cpus, "--cpus", "Processors of a task, and threads of its command")
                .in(Unit::count)
                .within(at_least(1)),
            option("", limits.memory_gib, "--memory",
                   "Largest memory of a task, GiB; without it what `estimate` says, and a margin")
                .in(Unit::gibibytes)
                .within(above(0).at_most(FarmLimits::kMostMemoryGib)),
            option("", limits.minutes, "--minutes",
                   "Longest time of a task; without it what `estimate` says, and a margin")
                .within(above(0).at_most(FarmLimits::kMostMinutes)),
            option("", limits.at_once, "--at-once", "Tasks at the same time; 0 is as it comes")
                .in(Unit::count)
                .within(at_least(0))
                .needing("--engine slurm"),
            option("", limits.retries, "--retries",
                   "How often a task that was killed is put back into the queue")
                .in(Unit::count)
                .within(at_least(0))
                .needing("--engine slurm")};
}

/// What neither an engine nor a shell gives a meaning to.
std::string job_name(const FarmArguments& arguments)
{
    std::string name = arguments.name.empty() ? arguments.job.stem().string() : arguments.name;
    const bool plain = std::all_of(name.begin(), name.end(), [](unsigned char c) {
        return std::isalnum(c) != 0 || c == '.' || c == '_' || c == '-';
    });
    if (!plain || name.empty() || name.front() == '-')
        throw InvalidOption("the job's name is \"" + name +
                            "\", must be letters, digits, . _ - (--name)");
    return name;
}

/// Names that stand in the job as they are.
void require_one_line(const fs::path& path, const char* what)
{
    // A line break would end one of sbatch's lines. A backslash in a name of a log has sbatch
    // replace none of the signs behind it.
    if (path.string().find_first_of("\n\r\\") != std::string::npos)
        throw InvalidOption(std::string(what) + " \"" + path.string() +
                            "\" has a line break or a backslash, which has no place in a job");
}

/// As Linux names the file of a running process. Slurm's machines mostly see the same disks, so
/// they know it by this path.
std::string own_program()
{
    std::error_code unknown;
    const fs::path self = fs::read_symlink("/proc/self/exe", unknown);
    return unknown ? "vdb_shell" : self.string();
}

/// An array is for programs that write lists: in it nothing has to be quoted.
std::vector<std::string> words_of_line(const std::string& line, const std::string& place)
{
    if (line.front() != '[')
        return split_words(line, place);
    try {
        return nlohmann::json::parse(line).get<std::vector<std::string>>();
    } catch (const nlohmann::json::exception& error) {
        // The parser quotes the word at which it stopped, however long it is.
        constexpr std::size_t kMostOfReason = 200;
        throw InvalidOption(
            place + ": is no JSON array of words: " + shown_in_part(error.what(), kMostOfReason));
    }
}

/// Line by line, so that an error names the line; the first one ends it.
std::vector<FarmCall> calls_in(const fs::path& list, const Context& context)
{
    std::ifstream in(list);
    if (!in)
        throw ReadError(list.string() + ": cannot be read as a list of calls");
    std::vector<FarmCall> calls;
    std::size_t number = 0;
    for (std::string line; std::getline(in, line);) {
        const std::string place = list.string() + ": line " + std::to_string(++number);
        line.erase(0, line.find_first_not_of(" \t\r"));
        if (line.empty() || line.front() == '#')
            continue;
        std::vector<std::string> words = words_of_line(line, place);
        // A line may be one that was typed.
        if (!words.empty() && words.front() == "vdb_shell")
            words.erase(words.begin());
        calls.push_back(plan_call(words_of(words), place, context));
    }
    if (calls.empty())
        throw InvalidOption(list.string() + ": there is no call in it");
    return calls;
}

std::vector<FarmCall> given_calls(const FarmArguments& arguments, const Context& context)
{
    if (!arguments.calls.empty())
        return calls_in(arguments.calls, context);
    std::vector<FarmCall> calls{plan_call(arguments.call, "", context)};
    // A list may hold single runs, for there are many of them.
    if (calls.front().frames.empty())
        throw InvalidOption("the call behind -- has no --frames, and one run alone needs no farm; "
                            "--calls takes a list of them");
    return calls;
}

std::size_t chunk_of(const FarmArguments& arguments, const FarmJob& job,
                     const std::optional<StepCost>& cost)
{
    // Never more tasks than an array takes, however long one of them gets; `--chunk` is taken at
    // its word, and its author knows the engine.
    const std::size_t steps = job.steps(), least = (steps + kMostTasks - 1) / kMostTasks;
    if (arguments.chunk > 0)
        return std::size_t(arguments.chunk);
    return std::max({least, std::size_t(1), cost ? chunk_for(*cost, steps) : 1});
}

void require_utf8(const std::string& word)
{
    try {
        static_cast<void>(nlohmann::json(word).dump());
    } catch (const nlohmann::json::type_error&) {
        throw InvalidOption("\"" + shown(word) +
                            "\" is no UTF-8, which a job of this engine has to be; --engine slurm "
                            "takes any name");
    }
}

void require_utf8(const FarmJob& job)
{
    for (const fs::path& path : {fs::path(job.program), job.home, job.folder})
        require_utf8(path.string());
    for (const FarmCall& call : job.calls) {
        require_utf8(call.manifest.string());
        for (const std::string& word : call.words)
            require_utf8(word);
    }
}

/// Also throws for what the engine's form cannot hold, which is why a plan makes the text as well.
std::string text_of_job(const FarmArguments& arguments, const FarmJob& job)
{
    // A script has any bytes. The others are JSON, and with other bytes in the place of those that
    // are no UTF-8 tasks would ask for other files.
    if (arguments.engine != Engine::slurm)
        require_utf8(job);
    switch (arguments.engine) {
    case Engine::slurm:
        return slurm_script(job, arguments.job.string());
    case Engine::openjd:
        return openjd_template(job, arguments.job, arguments.task_chunking);
    case Engine::tops:
        return tops_list(job);
    }
    return "";
}

/// In a job every path is whole: machines have other folders to begin in.
FarmJob job_of(const FarmArguments& arguments, const Context& context, bool with_estimate)
{
    FarmJob job;
    job.name = job_name(arguments);
    job.program = !arguments.program.empty()          ? arguments.program
                  : arguments.engine == Engine::slurm ? own_program()
                                                      : "vdb_shell";
    // Where relative names of the calls are meant from: that is the folder of who writes the job.
    job.home = current_folder();
    fs::path folder = arguments.folder;
    if (folder.empty())
        folder = fs::path(arguments.job).replace_extension(".tasks");
    job.folder = absolute_path(folder);
    require_one_line(arguments.job, "the name of the job");
    require_one_line(job.folder, "the folder");
    require_one_line(job.home, "the folder");
    require_one_line(job.program, "the program");
    job.limits = arguments.limits;
    job.calls = given_calls(arguments, context);
    // After all calls are planned, which needs their outputs; before tasks are made of them, for a
    // task may hold several calls in any order.
    require_apart(job.calls);
    for (std::size_t c = 0; c < job.calls.size(); ++c)
        // The name counts calls and not assets: two lines of a list may well have one name.
        if (job.calls[c].manifest.empty())
            job.calls[c].manifest = job.folder / ("call-" + std::to_string(c) + ".json");
    std::optional<StepCost> cost;
    if (with_estimate)
        cost = dearest_step(job.calls, job.limits.cpus, context);
    job.chunk = chunk_of(arguments, job, cost);
    job.tasks = tasks_of(job.calls, job.chunk);
    // After the tasks, whose size decides how long one takes.
    if (cost)
        set_limits(job, *cost);
    return job;
}

void require_engine_is_there(const FarmArguments& arguments)
{
    if (arguments.submit && fill::find_program("sbatch").empty())
        throw ProgramError("--submit: no Slurm there: sbatch is not in the folders of PATH; "
                           "nothing was written");
}

/// Prints what sbatch says: the numbers of the array and of the job that joins.
void submit(const FarmArguments& arguments, Context& context)
{
    SignalInterrupter interrupter(context);
    constexpr double kSeconds = 120;
    context.out << fill::run_program(fill::find_program("bash"),
                                     {absolute_path(arguments.job).string(), "submit"},
                                     fill::TemporaryFolder().path(), kSeconds, &interrupter);
}

} // namespace

const NameTable<Engine>& names(Engine)
{
    static const NameTable<Engine> table{
        {"slurm", Engine::slurm}, {"openjd", Engine::openjd}, {"tops", Engine::tops}};
    return table;
}

BoundOptions add_farm_command(CLI::App& app, FarmArguments& arguments)
{
    app.add_option("call", arguments.call,
                   "Behind --: a command with its options and --frames, as it would be typed");
    return bind(app, {{"", in_group("Job", job_options(arguments))},
                      {"", in_group("Tasks", task_options(arguments))}});
}

FilePlan plan_farm(const FarmArguments& arguments)
{
    if (arguments.call.empty() == arguments.calls.empty())
        throw InvalidOption("either a call behind --, or a list of them by --calls");
    FilePlan plan(existing_files(arguments.no_clobber));
    plan.add_input(arguments.calls);
    plan.add_output(arguments.job);
    require_engine_is_there(arguments);
    OutText unheard;
    const Context silent{unheard, unheard, LogLevel::error, MessageFormat::text, {}};
    // Without an estimate, which would read a surface: a plan reads nothing. A list of calls is a
    // file too, and is looked at by the run.
    if (!arguments.call.empty())
        text_of_job(arguments, job_of(arguments, silent, false));
    return plan;
}

int run_farm(const FarmArguments& arguments, Context& context)
{
    const FarmJob job = job_of(arguments, context, true);
    const std::string text = text_of_job(arguments, job);
    OutputSet files(existing_files(arguments.no_clobber));
    files.write_stream(arguments.job, [&](std::ostream& out) { out << text; });
    files.commit();
    context.out << arguments.job.string() << ": " << job.steps() << " frames or runs in "
                << job.tasks.size() << " tasks\n";
    if (arguments.submit)
        submit(arguments, context);
    return success;
}

} // namespace vdb_shell::command
