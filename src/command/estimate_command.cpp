// SPDX-License-Identifier: Apache-2.0

// The command `estimate`: what a call would cost, before it runs. It has the options of `build`, so
// that a build is estimated by another first word; or it is given a whole call behind --, as farm
// is, with its frames. Outputs are not written, they are what the files' size is told of.

#include "command/estimate_command.h"

#include "vdb_shell/core/error.h"
#include "vdb_shell/core/output_set.h"

#include "command/call.h"
#include "command/cost_model.h"
#include "command/exit_code.h"
#include "command/sequence.h"
#include "core/parallel.h"
#include "core/text_stream.h"

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <ostream>

namespace vdb_shell::command
{
namespace
{

using nlohmann::ordered_json;

/// Raised when keys of the document change their meaning.
constexpr int kEstimateSchema = 1;
constexpr double kMib = 1024.0 * 1024.0;

/// A call without frames, or all its frames, which are taken to cost what the first one does.
struct Estimate {
    std::string command;
    std::size_t frames = 1;
    int threads = 1;
    CallCost cost;

    double seconds() const { return double(frames) * cost.seconds(threads); }
    double disk() const { return double(frames) * cost.disk; }
};

ordered_json json_of(const Estimate& estimate)
{
    const CallCost& cost = estimate.cost;
    ordered_json json;
    json["command"] = estimate.command;
    json["file"] = cost.file;
    json["frames"] = estimate.frames;
    json["triangles"] = std::llround(cost.triangles);
    json["voxel_size"] = cost.voxel_size;
    json["seconds"] = cost.seconds(estimate.threads);
    json["cpu_seconds"] = cost.cpu_seconds;
    json["memory_bytes"] = std::llround(cost.memory);
    json["disk_bytes"] = std::llround(cost.disk);
    json["not_counted"] = cost.not_counted;
    return json;
}

std::string cost_text(const Estimate& estimate)
{
    const CallCost& cost = estimate.cost;
    OutText text;
    text << cost.file << ": " << std::setprecision(9) << cost.triangles << " triangles";
    if (cost.voxel_size > 0)
        text << ", voxel size " << cost.voxel_size;
    text << std::setprecision(2) << ", " << cost.seconds(estimate.threads) << " s on "
         << estimate.threads << (estimate.threads == 1 ? " thread" : " threads")
         << std::setprecision(3) << ", " << cost.memory / kMib << " MiB of memory, "
         << cost.disk / kMib << " MiB of files";
    if (estimate.frames > 1)
        text << "; all " << estimate.frames << " frames one after the other "
             << std::setprecision(2) << estimate.seconds() << " s" << std::setprecision(3) << ", "
             << estimate.disk() / kMib << " MiB";
    std::string more;
    for (const std::string& name : cost.not_counted)
        more += (more.empty() ? "" : ", ") + name;
    if (!more.empty())
        text << "; not counted: " << more;
    return text.str();
}

/// What stands behind -- begins with a command's name, which no surface has: those go by their
/// extension.
bool is_call(const EstimateArguments& arguments)
{
    return is_modelled(arguments.words.front());
}

/// Its frames, planned as the command itself would plan them. Inputs need not be there, but for
/// those of the first frame.
std::vector<Step> steps_of(const EstimateArguments& arguments, GlobalArguments& global,
                           const Context& context)
{
    const std::vector<std::string> words = words_of(arguments.words);
    Call call;
    call.parse(words);
    global = call.global();
    // Then plan_steps lets inputs be missing: a job is estimated before the files of all its frames
    // are there.
    global.keep_going = true;
    return plan_steps(words, global, context);
}

/// Of a whole call: the first frame is read and counted, the others are taken to cost the same.
Estimate estimate_words(const EstimateArguments& arguments, const Context& context)
{
    GlobalArguments global;
    const std::vector<Step> steps = steps_of(arguments, global, context);
    Call first;
    first.parse(steps.front().words);
    // Sets the command's own options; the plan itself has been made by steps_of.
    first.plan();
    return {first.name(), steps.size(), global.threads > 0 ? global.threads : int(thread_count()),
            estimate_call(first)};
}

/// CLI11's own messages, for words that it did not get from the user's command line as such.
template <typename Body> void with_errors_of_call(const Body& body)
{
    try {
        body();
    } catch (const CLI::ParseError& error) {
        throw InvalidOption("the call behind --: " + std::string(error.what()));
    }
}

/// One for a call, or one for each surface, all with the options of `build` that were given.
std::vector<Estimate> estimates_of(const EstimateArguments& arguments, const Context& context)
{
    std::vector<Estimate> estimates;
    if (is_call(arguments)) {
        with_errors_of_call([&] { estimates.push_back(estimate_words(arguments, context)); });
        return estimates;
    }
    for (const std::string& mesh : arguments.words) {
        BuildArguments build = arguments.build;
        build.mesh = mesh;
        // Threads are those of this command: it has the flag that the build would have.
        estimates.push_back({"build", 1, int(thread_count()), estimate_build(build)});
    }
    return estimates;
}

} // namespace

BoundOptions add_estimate_command(CLI::App& app, EstimateArguments& arguments)
{
    app.add_option("mesh", arguments.words,
                   std::string("Surfaces: ") + kSurfaceExtensions +
                       "; or behind -- a call of build, pose or deform, as it would be typed")
        ->required();
    return bind(app, describe(arguments.build));
}

FilePlan plan_estimate(const EstimateArguments& arguments)
{
    const BuildArguments& build = arguments.build;
    FilePlan plan(existing_files(build.outputs.no_clobber));
    if (is_call(arguments)) {
        // Options before -- are those of a build's surfaces. With a call behind it they would be
        // without effect, and -o looks as if it had one.
        if (!build.outputs.paths.empty())
            throw InvalidOption("the call stands behind --, with all its options: estimate -- " +
                                arguments.words.front() + " ...");
        OutText unheard; // what is to be said is said by the run
        const Context silent{unheard, unheard, LogLevel::error, MessageFormat::text, {}};
        GlobalArguments global;
        with_errors_of_call([&] {
            const std::vector<Step> steps = steps_of(arguments, global, silent);
            for (const std::filesystem::path& input : steps.front().inputs)
                plan.add_input(input);
        });
    } else {
        for (const std::string& mesh : arguments.words) {
            require_format(mesh, build.format);
            plan.add_input(mesh);
        }
    }
    plan.add_input(build.preset);
    if (!build.report.empty() && !is_standard_output(build.report))
        plan.add_output(build.report);
    return plan;
}

int run_estimate(const EstimateArguments& arguments, Context& context)
{
    const std::filesystem::path& report = arguments.build.report;
    ordered_json meshes = ordered_json::array();
    double seconds = 0, memory = 0, disk = 0;
    for (const Estimate& estimate : estimates_of(arguments, context)) {
        seconds += estimate.seconds();
        // One after the other: memory is given back between them, files stay.
        memory = std::max(memory, estimate.cost.memory);
        disk += estimate.disk();
        meshes.push_back(json_of(estimate));
        if (!is_standard_output(report) && !arguments.build.quiet)
            context.out << cost_text(estimate) << '\n';
    }
    ordered_json json{{"schema", kEstimateSchema}, {"threads", thread_count()}};
    json["meshes"] = std::move(meshes);
    json["seconds"] = seconds;
    json["memory_bytes"] = std::llround(memory);
    json["disk_bytes"] = std::llround(disk);
    // Names of files may be no UTF-8, which JSON has to be.
    const std::string text =
        json.dump(2, ' ', false, ordered_json::error_handler_t::replace) + '\n';
    if (is_standard_output(report)) {
        context.out << text;
    } else if (!report.empty()) {
        OutputSet files(existing_files(arguments.build.outputs.no_clobber));
        files.write_stream(report, [&](std::ostream& out) { out << text; });
        files.commit();
    }
    return success;
}

} // namespace vdb_shell::command
