// SPDX-License-Identifier: Apache-2.0

// The command `pose`: a shell's file and its surface in a pose in, files of the posed shell out.
// The surface has to have the triangles of the shell's, or it comes with the same surface at rest,
// to whose triangles the shell's vertices are tied. Shells of a pose can be posed again: what
// counts is where their points were at rest.

#include "command/pose_command.h"

#include "vdb_shell/core/error.h"
#include "vdb_shell/pipeline.h"

#include "command/exit_code.h"
#include "command/file_commands.h"
#include "command/pose_motion.h"
#include "command/posed_surface.h"
#include "command/signals.h"
#include "options/parse_json.h"
#include "report/stage_clock.h"

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include <memory>
#include <mutex>
#include <ostream>
#include <string>
#include <utility>
#include <vector>

namespace vdb_shell::command
{

/// A shell's file, with all that is the same for each of its poses.
struct PreparedShell {
    std::filesystem::path path;
    ShellFile file;
    RestShell rest;
};

namespace
{

using openvdb::Vec3s;

OptionSections describe(PoseArguments& a)
{
    OptionSections sections{
        {"", in_group("Options", {preset_option(a.preset), input_format_option(a.format)})}};
    for (OptionSection& section : vdb_shell::command::describe(a.outputs))
        sections.push_back(std::move(section));
    const OptionList figures{
        option("", a.report, "--report",
               "Write all figures as JSON; - is standard output, in place of the text"),
        option("", a.quiet, "--quiet", "Print no figures").with_names({"-q"})};
    sections.push_back({"", in_group("Output", figures)});
    const OptionList meshes{
        option("", a.rest_mesh, "--rest-mesh",
               "The surface at rest, where the posed one has other triangles than the shell's: "
               "vertices go with the nearest triangle"),
        option("", a.before, "--mesh-before",
               "The surface one frame before, for velocities; its tokens have that frame's number. "
               "Left out where there is no such file"),
        option("", a.after, "--mesh-after", "The surface one frame after, the same"),
        option("", a.frame_seconds, "--frame-seconds", "From one frame to the next")
            .within(above(0))
            .needing("--mesh-before or --mesh-after")};
    sections.push_back({"", in_group("Pose", meshes)});
    sections.push_back({"pose", vdb_shell::describe(a.pose)});
    return sections;
}

/// Frames of a call that pose the same shell read it once.
std::shared_ptr<const PreparedShell> prepare(const std::filesystem::path& path, Context& context)
{
    const auto make = [&] {
        ShellFile file = read_shell(path);
        // The figures of poses are put over it. Refused before the work, and by the name of its
        // file, which the poses do not know.
        const std::string report = path.string() + ": its report";
        if (!parse_json(file.report_json, report).is_object())
            throw ReadError(report + ": is no JSON object");
        RestShell rest(rest_stack(file), rest_core(file));
        return std::make_shared<const PreparedShell>(
            PreparedShell{path, std::move(file), std::move(rest)});
    };
    if (!context.sequence)
        return make();
    const std::lock_guard<std::mutex> lock(context.sequence->mutex);
    std::shared_ptr<const PreparedShell>& known = context.sequence->prepared;
    // Held by the lock while it is read: other frames that want the same file wait, and do not read
    // it too. A frame that keeps a pointer keeps the shell, should the next one name another.
    if (!known || known->path != path)
        known = make();
    return known;
}

/// The first frame of a shot has none before it, the last one none after it.
bool is_there(const std::filesystem::path& neighbour)
{
    std::error_code unknown;
    const bool there = !neighbour.empty() && std::filesystem::exists(neighbour, unknown);
    // Not taken for the end of a shot: the poses would lack velocities, and nobody would know.
    if (unknown)
        throw ReadError(neighbour.string() + ": cannot be read: " + unknown.message());
    return there;
}

/// Frames of a call share what they pose; each pose is the same whoever makes it.
std::shared_ptr<PoseCache> cache_of(Context& context)
{
    if (!context.sequence)
        return std::make_shared<PoseCache>();
    const std::lock_guard<std::mutex> lock(context.sequence->mutex);
    if (!context.sequence->poses)
        context.sequence->poses = std::make_shared<PoseCache>();
    return context.sequence->poses;
}

/// With velocities where a neighbour is there.
PosedShell posed_shell(const PoseArguments& arguments, const PreparedShell& prepared,
                       Context& context, Interrupter* interrupter)
{
    const auto skin_of = [&](const std::filesystem::path& mesh) {
        return read_posed_skin({mesh, arguments.format, arguments.rest_mesh}, prepared.rest.stack(),
                               prepared.file.placement, arguments.shell);
    };
    const std::vector<Vec3s> skin = skin_of(arguments.mesh);
    const std::string name = arguments.mesh.filename().string();
    // Without neighbours no pose is wanted twice, and the cache would only hold memory.
    if (!is_there(arguments.before) && !is_there(arguments.after)) {
        // Also at an end of a shot one neighbour is there, so the names may be misspelt.
        if (!arguments.before.empty() || !arguments.after.empty())
            context.say(
                LogLevel::warning,
                name + ": no velocities, for there is no " +
                    (arguments.before.empty() ? arguments.after : arguments.before).string());
        return build_posed(prepared.rest, skin, arguments.pose, name, interrupter);
    }
    const std::shared_ptr<PoseCache> cache = cache_of(context);
    const auto pose_of = [&](const std::filesystem::path& mesh) {
        // Neighbours are posed with the same options as their own frames are, so a frame finds its
        // neighbours' poses, and they find its.
        return cache->get(mesh, [&] {
            return pose_shell(prepared.rest, mesh == arguments.mesh ? skin : skin_of(mesh),
                              arguments.pose, interrupter);
        });
    };
    const PoseCache::Pose own = pose_of(arguments.mesh);
    int frames = 0;
    const auto neighbour = [&](const std::filesystem::path& mesh) {
        const bool there = is_there(mesh);
        frames += there;
        // At an end of the shot the frame stands in for the neighbour that is missing; the
        // difference is then one frame's, and else two frames'.
        return there ? pose_of(mesh) : own;
    };
    const PoseCache::Pose before = neighbour(arguments.before), after = neighbour(arguments.after);
    PosedShell posed = finish_posed(prepared.rest, skin, *own, name, interrupter);
    // Of points of two poses, and not of the skin alone: so inner points have the velocity with
    // which they really go.
    posed.velocity = point_velocities(*before, *after, frames * arguments.frame_seconds);
    return posed;
}

/// Where the skin crosses itself parts of the shell have to overlap: no fault of the shell's, if
/// every tet is positive.
int status_of_pose(const ShellReport& report, const Context& context)
{
    const std::string faults = faults_of(report);
    // A shell there is valid, and lies on the other side than at rest.
    if (report.mesh.inside_out_components() > 0)
        context.say(LogLevel::warning, report.source + ": the skin is inside out, as a mirrored "
                                                       "one is whose triangles were not turned");
    if (faults.empty())
        return success;
    const bool positive = report.signs.inverted.count + report.signs.flat.count == 0 &&
                          report.conformity.conforming();
    if (positive && report.mesh.self_intersections.count > 0) {
        context.say(LogLevel::warning,
                    report.source + ": the skin crosses itself; " + report.overlaps->summary());
        return success;
    }
    context.say_failed(check_failed, report.source, "the shell is NOT VALID: " + faults);
    return check_failed;
}

} // namespace

BoundOptions add_pose_command(CLI::App& app, PoseArguments& arguments)
{
    app.add_option("shell", arguments.shell,
                   "The shell at rest: a .vdb, .geo, .bgeo or .bgeo.sc that vdb_shell wrote")
        ->required();
    app.add_option("mesh", arguments.mesh,
                   std::string("Its surface in the pose: ") + kSurfaceExtensions)
        ->required();
    return bind(app, describe(arguments));
}

FilePlan plan_pose(const PoseArguments& arguments)
{
    if (arguments.outputs.paths.empty() && arguments.report.empty() && arguments.quiet)
        throw InvalidOption("no output, no report and --quiet: nothing would come of the work");
    require_format(arguments.mesh, arguments.format);
    FilePlan plan(existing_files(arguments.outputs.no_clobber));
    plan.add_input(arguments.shell);
    plan.add_input(arguments.mesh);
    plan.add_input(arguments.rest_mesh);
    for (const std::filesystem::path& neighbour : {arguments.before, arguments.after})
        // One that is missing is no error: so one call serves all frames of a shot, with its ends.
        if (is_there(neighbour))
            plan.add_input(neighbour);
    plan.add_input(arguments.preset);
    add_outputs(plan, arguments.outputs);
    if (!arguments.report.empty() && !is_standard_output(arguments.report))
        plan.add_output(arguments.report);
    return plan;
}

int run_pose(const PoseArguments& arguments, Context& context)
{
    FilePlan plan = plan_pose(arguments);
    add_points_file(plan, arguments.shell);
    SignalInterrupter interrupter(context);
    const std::shared_ptr<const PreparedShell> prepared = prepare(arguments.shell, context);
    const ShellFile& rest = prepared->file;
    // Poses take the voxels of the shell at rest, so that volumes of a sequence have one lattice.
    // Refused before the work.
    if (wants_vdb(arguments.outputs) && !rest.surface)
        throw InvalidOption(arguments.shell.string() +
                            ": it has no level set, whose voxels a .vdb would have; pose the .vdb");
    PosedShell posed = posed_shell(arguments, *prepared, context, &interrupter);
    const std::vector<std::uint8_t> certified =
        certified_flags(posed.report.overlaps, posed.tets.tets.size());
    // A copy, for the shell is moved into its file below, and the report outlives it.
    ShellReport report = posed.report;
    OutputSet files(existing_files(arguments.outputs.no_clobber));
    StageClock(report.stages, &interrupter).run("write", [&] {
        const bool volumes = wants_vdb(arguments.outputs);
        write_outputs(arguments.outputs, posed_file(rest, std::move(posed), volumes, &interrupter),
                      certified, files);
    });
    const std::string json =
        arguments.report.empty() ? "" : posed_report_json(report, rest.report_json) + '\n';
    const bool to_output = is_standard_output(arguments.report);
    if (!json.empty() && !to_output)
        files.write_stream(arguments.report, [&](std::ostream& out) { out << json; });
    files.commit();
    if (to_output || !arguments.quiet)
        context.out << (to_output ? json : posed_report_text(report));
    return status_of_pose(report, context);
}

} // namespace vdb_shell::command
