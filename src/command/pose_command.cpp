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
#include "command/file_plan.h"
#include "command/signals.h"
#include "command/surface_input.h"
#include "report/stage_clock.h"

#include <CLI/CLI.hpp>

#include <iostream>
#include <utility>
#include <vector>

namespace vdb_shell::command
{
namespace
{

using openvdb::Vec3d;
using openvdb::Vec3s;

OptionSections describe(PoseArguments& a)
{
    OptionSections sections{{"", {preset_option(a.preset)}}};
    for (OptionSection& section : vdb_shell::command::describe(a.outputs))
        sections.push_back(std::move(section));
    sections.push_back(
        {"", in_group("Output",
                      {option("", a.report, "--report",
                              "Write all figures as JSON; - is standard output, in place of the "
                              "text"),
                       option("", a.quiet, "--quiet", "Print no figures").with_names({"-q"}),
                       option("", a.progress, "--progress",
                              "Name each stage on standard error as it begins")})});
    sections.push_back(
        {"", in_group("Pose", {option("", a.rest_mesh, "--rest-mesh",
                                      "The surface at rest, where the posed one has other "
                                      "triangles than the shell's: vertices go with the nearest "
                                      "triangle")})});
    sections.push_back({"pose", vdb_shell::describe(a.pose)});
    return sections;
}

/// The mesh in the frame of the shell's.
TriangleMesh read_placed(const std::filesystem::path& path, const Placement& placement, bool weld)
{
    ReadOptions options;
    options.weld = weld;
    // Where the shell keeps digits of its own, so must the pose.
    options.recentre = placement.moves();
    ReadResult read = read_surface(path, options);
    const Placement& own = read.report.placement;
    if (own.moves() || placement.moves())
        for (Vec3s& p : read.mesh.points)
            p = Vec3s((own.in_file(p) - placement.origin) / placement.unit);
    return std::move(read.mesh);
}

bool same_triangles(const TriangleMesh& mesh, std::size_t vertices,
                    const std::vector<openvdb::Vec3I>& triangles)
{
    return mesh.points.size() == vertices && mesh.triangles == triangles;
}

/// Equal vertices of the file are merged or not, whichever gives the triangles that are wanted: in
/// a pose other vertices can be equal than at rest.
TriangleMesh read_matching(const std::filesystem::path& path, const Placement& placement,
                           std::size_t vertices, const std::vector<openvdb::Vec3I>& triangles,
                           const std::string& wanted)
{
    TriangleMesh mesh = read_placed(path, placement, true);
    if (same_triangles(mesh, vertices, triangles))
        return mesh;
    TriangleMesh apart = read_placed(path, placement, false);
    if (same_triangles(apart, vertices, triangles))
        return apart;
    throw InvalidOption(path.string() + ": it has " + std::to_string(mesh.points.size()) +
                        " vertices and " + std::to_string(mesh.triangles.size()) +
                        " triangles that are not those of " + wanted + ", which has " +
                        std::to_string(vertices) + " and " + std::to_string(triangles.size()) +
                        "; --rest-mesh gives the same surface at rest where the shell's was "
                        "repaired, wrapped or remeshed");
}

std::vector<Vec3s> posed_skin(const PoseArguments& arguments, const ShellStack& at_rest,
                              const Placement& placement)
{
    const std::vector<Vec3s>& skin = at_rest.surface(at_rest.skin);
    if (arguments.rest_mesh.empty())
        return read_matching(arguments.mesh, placement, skin.size(), at_rest.triangles(),
                             "the surface of " + arguments.shell.string())
            .points;
    const TriangleMesh rest = read_placed(arguments.rest_mesh, placement, true);
    const TriangleMesh posed = read_matching(arguments.mesh, placement, rest.points.size(),
                                             rest.triangles, arguments.rest_mesh.string());
    return move_bound(bind_surface(skin, rest), posed);
}

void require_possible_files(const PoseArguments& arguments)
{
    FilePlan plan(existing_files(arguments.outputs.no_clobber));
    plan.add_input(arguments.shell);
    plan.add_input(arguments.mesh);
    plan.add_input(arguments.rest_mesh);
    plan.add_input(arguments.preset);
    add_outputs(plan, arguments.outputs);
    if (!arguments.report.empty() && !is_standard_output(arguments.report))
        plan.add_output(arguments.report);
    if (!houdini::has_geometry_extension(arguments.shell))
        plan.add_input(read_shell_info(arguments.shell).points_at);
    if (arguments.outputs.paths.empty() && arguments.report.empty() && arguments.quiet)
        throw InvalidOption("no output, no report and --quiet: nothing would come of the work");
}

std::vector<std::uint8_t> certified_flags(const PosedShell& posed)
{
    return posed.report.overlaps ? posed.report.overlaps->certified
                                 : std::vector<std::uint8_t>(posed.tets.tets.size(), 1);
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

int run_pose(const PoseArguments& arguments)
{
    require_possible_files(arguments);
    SignalInterrupter interrupter(arguments.progress);
    const ShellFile rest = read_shell(arguments.shell);
    if (wants_vdb(arguments.outputs) && !rest.surface)
        throw InvalidOption(arguments.shell.string() +
                            ": it has no level set, whose voxels a .vdb would have; pose the .vdb");
    const ShellStack at_rest = rest_stack(rest);
    const std::vector<Vec3s> skin = posed_skin(arguments, at_rest, rest.placement);
    const RestShell prepared(at_rest, rest_core(rest));
    PosedShell posed = build_posed(prepared, skin, in_unit(arguments.pose, rest.placement.unit),
                                   arguments.mesh.filename().string(), &interrupter);
    const std::vector<std::uint8_t> certified = certified_flags(posed);
    ShellReport report = posed.report;
    OutputSet files(existing_files(arguments.outputs.no_clobber));
    StageClock(report.stages).run("write", [&] {
        write_outputs(
            arguments.outputs,
            posed_file(rest, std::move(posed), wants_vdb(arguments.outputs), &interrupter),
            certified, files);
    });
    const bool to_output = is_standard_output(arguments.report);
    const std::string json =
        arguments.report.empty() ? "" : posed_report_json(report, rest.report_json) + '\n';
    if (!json.empty() && !to_output)
        files.write_stream(arguments.report, [&](std::ostream& out) { out << json; });
    files.commit();
    if (to_output)
        std::cout << json;
    else if (!arguments.quiet)
        std::cout << posed_report_text(report);
    const std::string faults = faults_of(report);
    if (!faults.empty())
        std::cerr << "vdb_shell: " << report.source << ": the shell is NOT VALID: " << faults
                  << '\n';
    return faults.empty() ? success : check_failed;
}

} // namespace vdb_shell::command
