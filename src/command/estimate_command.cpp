// SPDX-License-Identifier: Apache-2.0

// The command `estimate`: what a build with these options would cost, before it runs. It has the
// options of `build`, so that a call is estimated by another first word; outputs are not written,
// they are what the files' size is told of.

#include "command/estimate_command.h"

#include "vdb_shell/core/error.h"
#include "vdb_shell/core/output_set.h"

#include "command/cost_model.h"
#include "command/exit_code.h"

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <ostream>
#include <sstream>

namespace vdb_shell::command
{
namespace
{

using nlohmann::ordered_json;

/// Raised when keys of the document change their meaning.
constexpr int kSchema = 1;
constexpr double kMib = 1024.0 * 1024.0;

int thread_count()
{
    return static_cast<int>(
        tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism));
}

ordered_json json_of(const std::string& file, const BuildCost& cost)
{
    ordered_json json;
    json["file"] = file;
    json["triangles"] = std::llround(cost.triangles);
    json["voxel_size"] = cost.voxel_size;
    json["seconds"] = cost.seconds(thread_count());
    json["cpu_seconds"] = cost.cpu_seconds;
    json["memory_bytes"] = std::llround(cost.memory);
    json["disk_bytes"] = std::llround(cost.disk);
    json["not_counted"] = cost.not_counted;
    return json;
}

std::string text_of(const std::string& file, const BuildCost& cost)
{
    std::ostringstream text;
    text << std::setprecision(3) << file << ": " << std::setprecision(9) << cost.triangles
         << " triangles, voxel size " << cost.voxel_size << std::setprecision(2) << ", "
         << cost.seconds(thread_count()) << " s on " << thread_count()
         << (thread_count() == 1 ? " thread" : " threads") << std::setprecision(3) << ", "
         << cost.memory / kMib << " MiB of memory, " << cost.disk / kMib << " MiB of files";
    std::string more;
    for (const std::string& name : cost.not_counted)
        more += (more.empty() ? "" : ", ") + name;
    if (!more.empty())
        text << "; not counted: " << more;
    return text.str();
}

} // namespace

BoundOptions add_estimate_command(CLI::App& app, EstimateArguments& arguments)
{
    app.add_option("mesh", arguments.meshes, std::string("Surfaces: ") + kSurfaceExtensions)
        ->required();
    return bind(app, describe(arguments.build));
}

FilePlan plan_estimate(const EstimateArguments& arguments)
{
    const std::filesystem::path& report = arguments.build.report;
    FilePlan plan(Existing::replaced);
    for (const std::filesystem::path& mesh : arguments.meshes) {
        require_format(mesh, arguments.build.format);
        plan.add_input(mesh);
    }
    plan.add_input(arguments.build.preset);
    if (!report.empty() && !is_standard_output(report))
        plan.add_output(report);
    return plan;
}

int run_estimate(const EstimateArguments& arguments, Context& context)
{
    const std::filesystem::path& report = arguments.build.report;
    ordered_json meshes = ordered_json::array();
    double seconds = 0, memory = 0, disk = 0;
    for (const std::filesystem::path& mesh : arguments.meshes) {
        BuildArguments build = arguments.build;
        build.mesh = mesh;
        const BuildCost cost = estimate_build(build);
        seconds += cost.seconds(thread_count());
        memory = std::max(memory, cost.memory);
        disk += cost.disk;
        meshes.push_back(json_of(mesh.string(), cost));
        if (!is_standard_output(report) && !build.quiet)
            context.out << text_of(mesh.string(), cost) << '\n';
    }
    ordered_json json{{"schema", kSchema}, {"threads", thread_count()}};
    json["meshes"] = std::move(meshes);
    json["seconds"] = seconds;
    json["memory_bytes"] = std::llround(memory);
    json["disk_bytes"] = std::llround(disk);
    if (is_standard_output(report)) {
        context.out << json.dump(2) << '\n';
    } else if (!report.empty()) {
        OutputSet files;
        files.write_stream(report, [&](std::ostream& out) { out << json.dump(2) << '\n'; });
        files.commit();
    }
    return success;
}

} // namespace vdb_shell::command
