// SPDX-License-Identifier: Apache-2.0
#include "vdb_shell/pipeline.h"

#include "vdb_shell/core/error.h"
#include "vdb_shell/mesh/split_fans.h"

#include "core/option_names.h"
#include "core/stage_clock.h"
#include "pipeline_figures.h"
#include "pipeline_sides.h"

#include <nlohmann/json.hpp>

#include <utility>

namespace vdb_shell
{
namespace
{

void require_a_bound(const ShellOptions& options, const openvdb::FloatGrid* thickness_grid)
{
    if (options.side != Side::outward && options.line_step.test == StopTest::none &&
        options.limits.limit == Limit::none && !options.line_step.thickness && !thickness_grid)
        throw InvalidOption("the stop test is none, there is no limit and no thickness: nothing "
                            "would end the lines");
}

/// Copies of vertices make sense only where nothing else stands in the way: at an edge of three or
/// more triangles the fans are no fans of one surface.
bool may_split_fans(const MeshCheck& check, const CheckOptions& options)
{
    return options.allow_self_intersections && check.non_manifold_vertices.count > 0 &&
           check.non_manifold_edges.count == 0;
}

void take_surface(ShellResult& r, const TriangleMesh& mesh, const CheckOptions& options,
                  const std::string& name)
{
    r.surface = mesh;
    r.report.mesh = check_mesh(mesh);
    if (may_split_fans(r.report.mesh, options)) {
        FanSplit split = split_fans(mesh);
        r.surface = std::move(split.mesh);
        r.report.split_vertices = split.vertices;
        r.report.vertex_copies = split.copies;
        r.report.mesh = check_mesh(r.surface);
    }
    require_usable(r.report.mesh, options, name);
    r.surface = turn_outward(std::move(r.surface), r.report.mesh);
}

void make_layers(ShellResult& r, const ShellOptions& options, Interrupter* interrupter)
{
    LayerResult cut = cut_layers(r.stack, options.layers, prism_test(options), interrupter);
    r.stack = std::move(cut.stack);
    if (options.layers.layers > 1)
        r.report.cut = cut.report;
}

} // namespace

ShellResult build_shell(const TriangleMesh& mesh, const ShellOptions& options,
                        const std::string& name, const openvdb::FloatGrid* thickness_grid,
                        Interrupter* interrupter)
{
    require_a_bound(options, thickness_grid);
    require_sensible(options.scale);
    require_sensible(options.layers);
    ShellResult r;
    r.report.source = name;
    StageClock clock(r.report.stages);

    clock.run("check", [&] { take_surface(r, mesh, options.check, name); });
    clock.run("level set", [&] {
        r.level_set =
            mesh_to_level_set(r.surface, band_for(options, r.surface, thickness_grid), interrupter);
    });
    clock.run("smooth", [&] {
        r.report.field.smooth =
            smooth_level_set(*r.level_set, r.surface, options.smooth, interrupter);
    });
    build_sides(r, options, thickness_grid, clock, interrupter);
    clock.run("layers", [&] { make_layers(r, options, interrupter); });
    clock.run("tets", [&] { r.tets = make_tets(r.stack); });
    clock.run("certificate", [&] {
        r.report.certificate = certify_stack(r.stack, prism_test(options), interrupter);
    });
    if (!r.report.certificate->certified())
        clock.run("overlaps", [&] { r.report.overlaps = find_overlaps(r.tets, interrupter); });
    clock.run("figures", [&] { measure_result(r); });
    clock.run("coverage", [&] {
        // Layers outside are held against what the outermost surface encloses.
        const TriangleMesh solid = options.side == Side::inward
                                       ? r.surface
                                       : TriangleMesh{r.stack.surface(0), r.stack.triangles()};
        r.report.coverage = estimate_coverage(solid, r.tets, options.coverage, interrupter);
    });
    return r;
}

std::string options_json(const ShellOptions& options)
{
    auto or_null = [](const auto& optional) {
        return optional ? nlohmann::ordered_json(*optional) : nlohmann::ordered_json(nullptr);
    };
    nlohmann::ordered_json json;
    json["side"] = name_in_table(options.side);
    json["check"] = {{"allow_self_intersections", options.check.allow_self_intersections},
                     {"turn_inside_out", options.check.turn_inside_out}};
    json["level_set"] = {{"voxel_size", or_null(options.level_set.voxel_size)},
                         {"resolution", options.level_set.resolution},
                         {"exterior_voxels", options.level_set.exterior_voxels},
                         {"exterior_depth", or_null(options.level_set.exterior_depth)},
                         {"interior_depth", or_null(options.level_set.interior_depth)}};
    json["smooth"] = {{"iterations", options.smooth.iterations}};
    json["directions"] = {{"source", name_in_table(options.directions.source)},
                          {"perturbation_radians", options.directions.perturbation_radians},
                          {"seed", options.directions.seed}};
    json["line_step"] = {{"test", name_in_table(options.line_step.test)},
                         {"rho", options.line_step.rho},
                         {"step_voxels", options.line_step.step_voxels},
                         {"distance_threshold_voxels", options.line_step.distance_threshold_voxels},
                         {"bisection_iterations", options.line_step.bisection_iterations},
                         {"reference_voxels", options.line_step.reference_voxels},
                         {"sheet_angle_radians", options.line_step.sheet_angle_radians},
                         {"thickness", or_null(options.line_step.thickness)}};
    json["limits"] = {{"limit", name_in_table(options.limits.limit)}};
    json["grow"] = {{"method", name_in_table(options.grow.method)},
                    {"mend_directions", options.grow.mend_directions},
                    {"smooth_directions", options.grow.smooth_directions},
                    {"top_down", options.grow.top_down},
                    {"grow_lines", options.grow.grow_lines},
                    {"free_moves", options.grow.free_moves},
                    {"soft_contacts", options.grow.soft_contacts},
                    {"flips", options.grow.flips},
                    {"free_rounds", options.grow.free_rounds},
                    {"min_quality", options.grow.min_quality}};
    json["scale"] = {{"factor", options.scale.factor}};
    json["layers"] = {{"layers", options.layers.layers}, {"grading", options.layers.grading}};
    json["split"] = {{"rule", name_in_table(options.split.rule)}, {"seed", options.split.seed}};
    json["coverage"] = {{"samples", options.coverage.samples}, {"seed", options.coverage.seed}};
    return json.dump(2);
}

} // namespace vdb_shell
