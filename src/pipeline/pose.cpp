// SPDX-License-Identifier: Apache-2.0

// Takes: a shell at rest and its surface in a pose. Gives: the posed shell with its proofs and
// figures, and the file of it. The certificate asks for the tets that there are and no others: a
// pose has to keep the diagonals of the shell at rest, so nothing is said of other ones.

#include "vdb_shell/pipeline.h"

#include "core/grid_instances.h"
#include "report/stage_clock.h"
#include "vdb_shell/core/error.h"
#include "vdb_shell/field/level_set.h"
#include "vdb_shell/field/narrow_band.h"
#include "vdb_shell/options/option_value.h"
#include "vdb_shell/volume/rest_volume.h"

#include <cassert>
#include <cmath>
#include <utility>

namespace vdb_shell
{
namespace
{

void measure(PosedShell& posed)
{
    ShellReport& report = posed.report;
    report.prisms = posed.stack.layers.size() * posed.stack.triangles().size();
    const PrismShell hull = hull_of(posed.stack);
    for (std::size_t v = 0; v < hull.outer.size(); ++v)
        report.pinned_vertices += hull.pinned(v);
    report.ripples = posed.stack.splits.front().ripples;
    report.conformity = check_conformity(posed.stack, posed.tets);
    report.signs = count_tet_signs(posed.tets);
    report.quality = measure_quality(posed.tets);
    const std::vector<openvdb::Vec3s>& skin = posed.stack.surface(posed.stack.skin);
    report.solid_volume = signed_volume(skin, posed.stack.triangles());
    report.shell_volume = tet_volume(posed.tets);
    report.fill = report.shell_volume / report.solid_volume;
}

/// In the voxels of the level set at rest, so that a sequence has the same lattice throughout.
FloatGridPtr level_set_of(const PosedShell& posed, double voxel_size, Interrupter* interrupter)
{
    LevelSetOptions options;
    options.voxel_size = voxel_size;
    const TriangleMesh skin = skin_surface(posed.stack);
    // The signs of the narrow band's own field are for surfaces that do not cross themselves.
    if (posed.report.mesh.embedded())
        return mesh_to_narrow_band(skin, options, interrupter);
    options.interior_depth = options.exterior_voxels * voxel_size;
    return mesh_to_level_set(skin, options, interrupter);
}

} // namespace

PosedShell build_posed(const RestShell& rest, const std::vector<openvdb::Vec3s>& skin,
                       const PoseOptions& options, const std::string& name,
                       Interrupter* interrupter)
{
    std::vector<StageCost> stages;
    StageClock clock(stages, interrupter);
    PoseResult pose;
    clock.run("pose", [&] { pose = pose_shell(rest, skin, options, interrupter); });
    PosedShell posed = finish_posed(rest, skin, std::move(pose), name, interrupter);
    posed.report.stages.insert(posed.report.stages.begin(), stages.begin(), stages.end());
    return posed;
}

PosedShell finish_posed(const RestShell& rest, const std::vector<openvdb::Vec3s>& skin,
                        PoseResult pose, const std::string& name, Interrupter* interrupter)
{
    PosedShell posed;
    posed.stack = std::move(pose.stack);
    posed.core = std::move(pose.core);
    ShellReport& report = posed.report;
    report.pose = pose.report;
    report.source = name;
    StageClock clock(report.stages, interrupter);
    clock.run("tets", [&] { posed.tets = make_tets(posed.stack); });
    if (posed.tets.points.size() != rest.tets().points.size() ||
        posed.tets.tets != rest.tets().tets)
        throw GeometryError(name + ": the tets would not be those of the shell at rest: the pose "
                                   "puts two points of the shell into one place");
    clock.run("check", [&] {
        report.mesh = check_mesh({skin, posed.stack.triangles()}, interrupter);
    });
    clock.run("certificate", [&] {
        report.certificate = certify_stack(posed.stack, PrismTest::chosen_tets, interrupter);
    });
    if (!report.certificate->certified())
        clock.run("overlaps", [&] { report.overlaps = find_overlaps(posed.tets, interrupter); });
    clock.run("figures", [&] { measure(posed); });
    return posed;
}

PointVectors point_velocities(const PoseResult& before, const PoseResult& after, double seconds)
{
    assert(before.stack.surfaces() == after.stack.surfaces());
    assert(before.stack.surface(0).size() == after.stack.surface(0).size());
    assert(before.core.points.size() == after.core.points.size());
    if (!(seconds > 0 && std::isfinite(seconds)))
        throw InvalidOption("velocities of points: the poses are " + text_of(seconds) +
                            " s apart, must be positive and finite");
    const auto difference = [&](const std::vector<openvdb::Vec3s>& from,
                                const std::vector<openvdb::Vec3s>& to) {
        std::vector<openvdb::Vec3s> made;
        made.reserve(from.size());
        for (std::size_t i = 0; i < from.size(); ++i)
            made.emplace_back((openvdb::Vec3d(to[i]) - openvdb::Vec3d(from[i])) / seconds);
        return made;
    };
    PointVectors velocity;
    for (std::size_t k = 0; k < before.stack.surfaces(); ++k)
        velocity.surface.push_back(difference(before.stack.surface(k), after.stack.surface(k)));
    velocity.core = difference(before.core.points, after.core.points);
    return velocity;
}

ShellFile posed_file(const ShellFile& rest, PosedShell posed, bool with_volumes,
                     Interrupter* interrupter)
{
    ShellFile file;
    if (with_volumes && !rest.surface)
        throw InvalidOption("volumes of a pose: the shell at rest has no level set, whose voxel "
                            "size they take");
    if (with_volumes) {
        const double voxel_size = rest.surface->voxelSize()[0];
        file.surface = level_set_of(posed, voxel_size, interrupter);
        file.depth = shell_depth_grid(posed.tets, voxel_size, interrupter);
    }
    file.report_json = posed_report_json(posed.report, rest.report_json, false);
    file.parameters_json = rest.parameters_json;
    file.placement = rest.placement;
    file.rest = rest_points(rest);
    file.input = rest.input;
    file.rest.velocity = std::move(posed.velocity);
    file.stack = std::move(posed.stack);
    if (with_volumes)
        file.rest_volume =
            rest_volume(posed.tets, vectors_of_tet_points(posed.tets, {file.rest.surface, {}}),
                        rest.surface->voxelSize()[0], interrupter);
    if (with_volumes && !file.rest.velocity.empty())
        file.velocity_volume = velocity_volume(
            posed.tets, vectors_of_tet_points(posed.tets, {file.rest.velocity.surface, {}}),
            rest.surface->voxelSize()[0], interrupter);
    file.core = std::move(posed.core);
    file.tets = std::move(posed.tets);
    return file;
}

} // namespace vdb_shell
