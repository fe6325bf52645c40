// SPDX-License-Identifier: Apache-2.0

// The command `pose`: a shell's file and its surface in a pose in, files of the posed shell out.
// The surface has to have the triangles of the shell's, or it comes with the same surface at rest,
// to whose triangles the shell's vertices are tied. Shells of a pose can be posed again: what
// counts is where their points were at rest.

#include "command/pose_command.h"

#include "vdb_shell/core/error.h"
#include "vdb_shell/houdini/geometry_file.h"
#include "vdb_shell/pipeline.h"
#include "vdb_shell/pose/bind_surface.h"

#include "command/exit_code.h"
#include "command/file_commands.h"
#include "command/signals.h"
#include "report/stage_clock.h"

#include <CLI/CLI.hpp>

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

using openvdb::Vec3d;
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
    sections.push_back(
        {"", in_group("Pose", {option("", a.rest_mesh, "--rest-mesh",
                                      "The surface at rest, where the posed one has other "
                                      "triangles than the shell's: vertices go with the nearest "
                                      "triangle")})});
    sections.push_back({"pose", vdb_shell::describe(a.pose)});
    return sections;
}

/// The mesh in the frame of the shell's.
TriangleMesh read_placed(const std::filesystem::path& path, InputFormat format,
                         const Placement& placement, bool weld)
{
    ReadOptions options;
    options.weld = weld;
    // Where the shell keeps digits of its own, so must the pose.
    options.recentre = placement.moves();
    ReadResult read = read_surface(path, options, format);
    const Placement& own = read.report.placement;
    if (own.moves() || placement.moves())
        for (Vec3s& p : read.mesh.points)
            p = Vec3s((own.in_file(p) - placement.origin) / placement.unit);
    return std::move(read.mesh);
}

/// The triangles and the number of vertices that a mesh has to have, and whose they are.
struct Wanted {
    std::size_t vertices;
    const std::vector<openvdb::Vec3I>& triangles;
    std::string whose;
};

/// Equal vertices of the file are merged or not, whichever gives the triangles that are wanted: in
/// a pose other vertices can be equal than at rest. Standard input can be read only once.
TriangleMesh read_matching(const PoseArguments& arguments, const Placement& placement,
                           const Wanted& wanted)
{
    const auto fits = [&](const TriangleMesh& mesh) {
        return mesh.points.size() == wanted.vertices && mesh.triangles == wanted.triangles;
    };
    const std::filesystem::path& path = arguments.mesh;
    TriangleMesh mesh = read_placed(path, arguments.format, placement, true);
    if (fits(mesh))
        return mesh;
    if (arguments.format == InputFormat::by_extension) {
        TriangleMesh apart = read_placed(path, arguments.format, placement, false);
        if (fits(apart))
            return apart;
    }
    throw InvalidOption(path.string() + ": it has " + std::to_string(mesh.points.size()) +
                        " vertices and " + std::to_string(mesh.triangles.size()) +
                        " triangles that are not those of " + wanted.whose + ", which has " +
                        std::to_string(wanted.vertices) + " and " +
                        std::to_string(wanted.triangles.size()) +
                        "; --rest-mesh gives the same surface at rest where the shell's was "
                        "repaired, wrapped or remeshed");
}

std::vector<Vec3s> posed_skin(const PoseArguments& arguments, const ShellStack& at_rest,
                              const Placement& placement)
{
    const std::vector<Vec3s>& skin = at_rest.surface(at_rest.skin);
    if (arguments.rest_mesh.empty())
        return read_matching(
                   arguments, placement,
                   {skin.size(), at_rest.triangles(), "the surface of " + arguments.shell.string()})
            .points;
    const TriangleMesh rest =
        read_placed(arguments.rest_mesh, InputFormat::by_extension, placement, true);
    const TriangleMesh posed = read_matching(
        arguments, placement, {rest.points.size(), rest.triangles, arguments.rest_mesh.string()});
    return move_bound(bind_surface(skin, rest), posed);
}

/// Frames of a call that pose the same shell read it once.
std::shared_ptr<const PreparedShell> prepare(const std::filesystem::path& path, Context& context)
{
    const auto make = [&] {
        ShellFile file = read_shell(path);
        RestShell rest(rest_stack(file), rest_core(file));
        return std::make_shared<const PreparedShell>(
            PreparedShell{path, std::move(file), std::move(rest)});
    };
    if (!context.sequence)
        return make();
    const std::lock_guard<std::mutex> lock(context.sequence->mutex);
    std::shared_ptr<const PreparedShell>& known = context.sequence->prepared;
    if (!known || known->path != path)
        known = make();
    return known;
}

std::vector<std::uint8_t> certified_flags(const PosedShell& posed)
{
    return posed.report.overlaps ? posed.report.overlaps->certified
                                 : std::vector<std::uint8_t>(posed.tets.tets.size(), 1);
}

/// Where the skin crosses itself parts of the shell have to overlap: no fault of the shell's, if
/// every tet is positive.
int status_of(const ShellReport& report, const Context& context)
{
    const std::string faults = faults_of(report);
    if (faults.empty())
        return success;
    const bool positive = report.signs.inverted.count + report.signs.flat.count == 0 &&
                          report.conformity.conforming();
    if (positive && report.mesh.self_intersections.count > 0) {
        context.say(LogLevel::warning,
                    report.source + ": the skin crosses itself; " + report.overlaps->summary());
        return success;
    }
    context.say(LogLevel::error, report.source + ": the shell is NOT VALID: " + faults);
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
    plan.add_input(arguments.preset);
    add_outputs(plan, arguments.outputs);
    if (!arguments.report.empty() && !is_standard_output(arguments.report))
        plan.add_output(arguments.report);
    return plan;
}

int run_pose(const PoseArguments& arguments, Context& context)
{
    FilePlan plan = plan_pose(arguments);
    // The file says itself where its points are, if they are not in it.
    if (!houdini::has_geometry_extension(arguments.shell))
        plan.add_input(read_shell_info(arguments.shell).points_at);
    SignalInterrupter interrupter(context);
    const std::shared_ptr<const PreparedShell> prepared = prepare(arguments.shell, context);
    const ShellFile& rest = prepared->file;
    if (wants_vdb(arguments.outputs) && !rest.surface)
        throw InvalidOption(arguments.shell.string() +
                            ": it has no level set, whose voxels a .vdb would have; pose the .vdb");
    PosedShell posed =
        build_posed(prepared->rest, posed_skin(arguments, prepared->rest.stack(), rest.placement),
                    arguments.pose, arguments.mesh.filename().string(), &interrupter);
    const std::vector<std::uint8_t> certified = certified_flags(posed);
    ShellReport report = posed.report;
    OutputSet files(existing_files(arguments.outputs.no_clobber));
    StageClock(report.stages).run("write", [&] {
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
    return status_of(report, context);
}

} // namespace vdb_shell::command
