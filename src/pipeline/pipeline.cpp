// SPDX-License-Identifier: Apache-2.0
#include "vdb_shell/pipeline.h"

#include "vdb_shell/core/error.h"
#include "vdb_shell/repair/split_fans.h"

#include "core/option_names.h"
#include "pipeline/figures.h"
#include "pipeline/resample.h"
#include "pipeline/sides.h"
#include "report/stage_clock.h"

#include <nlohmann/json.hpp>

#include <utility>

namespace vdb_shell
{
namespace
{

void require_sensible(const ShellOptions& options, const openvdb::FloatGrid* thickness_grid)
{
    require_sensible(options.scale);
    require_sensible(options.layers);
    require_sensible(options.refine);
    require_sensible(options.decimate);
    if (options.refine.rounds > 0 && options.side == Side::outward)
        throw InvalidOption("refine: rounds is " + std::to_string(options.refine.rounds) +
                            ", but an outward shell has no solid to fill");
    if (options.wrap.wanted && options.repair)
        throw InvalidOption("wrap and repair: one or the other; a wrap needs no repaired surface");
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

/// Looks at r.surface and splits its fans where that is allowed.
void look_at_surface(ShellResult& r, const CheckOptions& options)
{
    r.report.mesh = r.report.repair ? r.report.repair->after : check_mesh(r.surface);
    if (!may_split_fans(r.report.mesh, options))
        return;
    FanSplit split = split_fans(std::move(r.surface));
    r.surface = std::move(split.mesh);
    r.report.split_vertices = split.vertices;
    r.report.vertex_copies = split.copies;
    r.report.mesh = check_mesh(r.surface);
}

void make_layers(ShellResult& r, const ShellOptions& options, Interrupter* interrupter)
{
    LayerResult cut = cut_layers(r.stack, options.layers, prism_test(options), interrupter);
    r.stack = std::move(cut.stack);
    if (options.layers.layers > 1)
        r.report.cut = cut.report;
}

/// The surface to work with, repaired when asked: in r.surface, looked at and found usable.
void prepare_surface(ShellResult& r, const TriangleMesh& mesh, const ShellOptions& options,
                     StageClock& clock, Interrupter* interrupter)
{
    const std::string& name = r.report.source;
    r.surface = mesh;
    if (options.repair) {
        RepairOptions repair = *options.repair;
        repair.keep_crossing_fills |= options.check.allow_self_intersections;
        clock.run("repair", [&] {
            RepairResult repaired = repair_mesh(mesh, repair, interrupter);
            r.surface = std::move(repaired.mesh);
            r.report.repair = std::move(repaired.report);
        });
    }
    clock.run("check", [&] {
        look_at_surface(r, options.check);
        require_usable(r.report.mesh, options.check,
                       r.report.repair ? name + " after --repair" : name);
        r.surface = turn_outward(std::move(r.surface), r.report.mesh);
    });
    resample_surface(r, options, clock, interrupter);
}

/// The level set that the lines step through: the given one where it is fit for that.
void make_field(ShellResult& r, const ShellOptions& options, const GrowStart& start,
                const openvdb::FloatGrid* given, const openvdb::FloatGrid* thickness_grid,
                Interrupter* interrupter)
{
    const LevelSetOptions band = band_for(options, r.surface, thickness_grid);
    std::string& origin = r.report.field.origin;
    const std::string dense_for = why_not_sparse(options, r, start, thickness_grid);
    origin = dense_for.empty() ? "a narrow band made of the surface, deeper where lines end"
                               : "made of the surface, dense for " + dense_for;
    if (given) {
        // A given band outside is as wide as its maker needed, not as the lines do.
        const std::string hindrance = options.side == Side::inward
                                          ? why_not_steppable(*given, r.surface, band)
                                          : "nothing is known outside its band";
        if (hindrance.empty()) {
            origin = "as given";
            r.level_set = given->deepCopy();
            return;
        }
        origin += ", for of the given one " + hindrance;
    }
    r.report.field.sparse = dense_for.empty();
    r.level_set = dense_for.empty() ? mesh_to_narrow_band(r.surface, band, interrupter)
                                    : mesh_to_level_set(r.surface, band, interrupter);
}

/// All stages from the check on. `given` may be null.
void build_from_surface(ShellResult& r, const TriangleMesh& mesh, const ShellOptions& options,
                        const openvdb::FloatGrid* given, const openvdb::FloatGrid* thickness_grid,
                        Interrupter* interrupter)
{
    StageClock clock(r.report.stages);
    prepare_surface(r, mesh, options, clock, interrupter);
    GrowStart start;
    clock.run("coarsen", [&] { start = start_of_growth(options, r.surface); });
    clock.run("level set",
              [&] { make_field(r, options, start, given, thickness_grid, interrupter); });
    clock.run("smooth", [&] {
        r.report.field.smooth =
            smooth_level_set(*r.level_set, r.surface, options.smooth, interrupter);
    });
    build_and_refine(r, options, start, thickness_grid, clock, interrupter);
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
}

} // namespace

ShellResult build_shell(const TriangleMesh& mesh, const ShellOptions& options,
                        const std::string& name, const openvdb::FloatGrid* thickness_grid,
                        Interrupter* interrupter)
{
    require_sensible(options, thickness_grid);
    ShellResult r;
    r.report.source = name;
    if (!options.wrap.wanted) {
        build_from_surface(r, mesh, options, nullptr, thickness_grid, interrupter);
        return r;
    }
    WrapResult wrap;
    StageClock(r.report.stages).run("wrap", [&] {
        wrap = wrap_mesh(mesh, options.wrap, interrupter);
    });
    r.report.wrap = wrap.report;
    build_from_surface(r, wrap.mesh, options, nullptr, thickness_grid, interrupter);
    return r;
}

ShellResult build_shell_from_level_set(const openvdb::FloatGrid& field, const ShellOptions& options,
                                       const std::string& name,
                                       const openvdb::FloatGrid* thickness_grid,
                                       Interrupter* interrupter)
{
    require_sensible(options, thickness_grid);
    if (options.wrap.wanted)
        throw InvalidOption(name + ": a wrap is for triangles; the surface of a level set is "
                                   "closed, manifold and embedded as it is");
    require_level_set(field, name);
    ShellResult r;
    r.report.source = name;
    TriangleMesh surface;
    StageClock(r.report.stages).run("contour", [&] {
        r.report.contour.emplace();
        surface = contour(field, options.contour, &*r.report.contour, interrupter);
    });
    build_from_surface(r, surface, options, &field, thickness_grid, interrupter);
    return r;
}

std::string options_json(const ShellOptions& options)
{
    auto or_null = [](const auto& optional) {
        return optional ? nlohmann::ordered_json(*optional) : nlohmann::ordered_json(nullptr);
    };
    nlohmann::ordered_json json;
    json["side"] = name_in_table(options.side);
    json["repair"] =
        options.repair
            ? nlohmann::ordered_json{{"weld_tolerance", options.repair->weld_tolerance},
                                     {"sliver_height", options.repair->sliver_height},
                                     {"cut_crossings", options.repair->cut_crossings},
                                     {"keep_crossing_fills", options.repair->keep_crossing_fills}}
            : nlohmann::ordered_json(nullptr);
    json["wrap"] = {{"wanted", options.wrap.wanted},
                    {"voxel_size", or_null(options.wrap.voxel_size)},
                    {"resolution", options.wrap.resolution},
                    {"adaptivity", options.wrap.adaptivity},
                    {"sheet_voxels", options.wrap.sheet_voxels},
                    {"keep_voids", options.wrap.keep_voids}};
    json["contour"] = {{"adaptivity", options.contour.adaptivity},
                       {"outer_only", options.contour.outer_only}};
    json["check"] = {{"allow_self_intersections", options.check.allow_self_intersections},
                     {"turn_inside_out", options.check.turn_inside_out}};
    json["decimate"] = {{"triangles", or_null(options.decimate.triangles)},
                        {"tolerance", or_null(options.decimate.tolerance)}};
    json["subdivide"] = {{"levels", options.subdivide.levels}};
    json["level_set"] = {{"voxel_size", or_null(options.level_set.voxel_size)},
                         {"resolution", options.level_set.resolution},
                         {"exterior_voxels", options.level_set.exterior_voxels},
                         {"exterior_depth", or_null(options.level_set.exterior_depth)},
                         {"interior_depth", or_null(options.level_set.interior_depth)}};
    json["field"] = name_in_table(options.field);
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
                    {"coarse_from", options.grow.coarse_from},
                    {"free_rounds", or_null(options.grow.free_rounds)},
                    {"min_quality", options.grow.min_quality}};
    json["refine"] = {{"rounds", options.refine.rounds},
                      {"by", name_in_table(options.refine.by)},
                      {"share", options.refine.share},
                      {"max_tets", or_null(options.refine.max_tets)},
                      {"target_fill", or_null(options.refine.target_fill)},
                      {"min_gain", options.refine.min_gain}};
    json["scale"] = {{"factor", options.scale.factor}};
    json["layers"] = {{"layers", options.layers.layers}, {"grading", options.layers.grading}};
    json["split"] = {{"rule", name_in_table(options.split.rule)}, {"seed", options.split.seed}};
    json["coverage"] = {{"samples", options.coverage.samples}, {"seed", options.coverage.seed}};
    return json.dump(2);
}

} // namespace vdb_shell
