// SPDX-License-Identifier: Apache-2.0
#include "vdb_shell/pipeline.h"

#include "vdb_shell/core/error.h"

#include "core/option_names.h"
#include "core/stage_clock.h"
#include "pipeline_figures.h"
#include "step/thickness.h"

#include <nlohmann/json.hpp>
#include <openvdb/tools/Count.h>

#include <algorithm>
#include <utility>

namespace vdb_shell
{
namespace
{

void require_a_bound(const ShellOptions& options, const openvdb::FloatGrid* thickness_grid)
{
    if (options.line_step.test == StopTest::none && options.limits.limit == Limit::none &&
        !options.line_step.thickness && !thickness_grid)
        throw InvalidOption("the stop test is none, there is no limit and no thickness: nothing "
                            "would end the lines");
}

/// A band no deeper than the longest line that the user allows.
LevelSetOptions band_for(const ShellOptions& options, const openvdb::FloatGrid* thickness_grid)
{
    LevelSetOptions band = options.level_set;
    if (band.interior_depth)
        return band;
    if (options.line_step.thickness)
        band.interior_depth = options.line_step.thickness;
    if (thickness_grid) {
        const double painted = openvdb::tools::minMax(thickness_grid->tree()).max();
        const double background = thickness_grid->background();
        const double deepest = std::max(painted, background);
        if (deepest > 0.0)
            band.interior_depth = std::min(band.interior_depth.value_or(deepest), deepest);
    }
    return band;
}

/// Growth, or for Method::raw the prisms straight from the lengths.
void make_shell(ShellResult& r, const ShellOptions& options,
                const openvdb::FloatGrid* thickness_grid, Interrupter* interrupter)
{
    if (options.grow.method == Method::raw) {
        r.shell = extrude(r.surface, r.directions, r.lengths);
        r.split = split_prisms(r.shell, options.split);
        return;
    }
    GrowResult grown = grow_shell(r.surface, r.directions, r.lengths,
                                  largest_lengths(r.surface, options.line_step, thickness_grid),
                                  options.grow, options.split, interrupter);
    r.shell = std::move(grown.shell);
    r.split = std::move(grown.split);
    r.report.grow = grown.report;
}

/// The twelve tets are what growth keeps positive by default, and what the raw shells are held
/// against; the thickest shells stand by their chosen tets alone.
PrismTest prism_test(const ShellOptions& options)
{
    return options.grow.method == Method::thickest ? PrismTest::chosen_tets
                                                   : PrismTest::twelve_tets;
}

/// The level set that the lines step through: the given one where it is fit for that.
void make_field(ShellResult& r, const ShellOptions& options, const openvdb::FloatGrid* given,
                const openvdb::FloatGrid* thickness_grid, Interrupter* interrupter)
{
    const LevelSetOptions band = band_for(options, thickness_grid);
    std::string& origin = r.report.field.origin;
    origin = "made of the surface";
    if (given) {
        const std::string hindrance = why_not_steppable(*given, r.surface, band);
        if (hindrance.empty()) {
            origin = "as given";
            r.level_set = given->deepCopy();
            return;
        }
        origin = "made anew of the surface, for of the given one " + hindrance;
    }
    r.level_set = mesh_to_level_set(r.surface, band, interrupter);
}

/// All stages from the check on. `given` may be null.
void build_from_surface(ShellResult& r, const TriangleMesh& mesh, const ShellOptions& options,
                        const openvdb::FloatGrid* given, const openvdb::FloatGrid* thickness_grid,
                        Interrupter* interrupter)
{
    StageClock clock(r.report.stages);
    clock.run("check", [&] {
        r.report.mesh = check_mesh(mesh);
        require_usable(r.report.mesh, options.check, r.report.source);
        r.surface = turn_outward(mesh, r.report.mesh);
    });
    clock.run("level set", [&] { make_field(r, options, given, thickness_grid, interrupter); });
    clock.run("smooth", [&] {
        r.report.field.smooth =
            smooth_level_set(*r.level_set, r.surface, options.smooth, interrupter);
    });
    clock.run("directions", [&] {
        r.directions = compute_directions(r.surface, *r.level_set, options.directions);
    });
    clock.run("line stepping", [&] {
        r.lengths = line_step(r.surface, *r.level_set, r.directions, options.line_step,
                              thickness_grid, interrupter);
    });
    clock.run("limits", [&] {
        apply_limits(r.lengths, vertex_limits(r.surface, r.directions, options.limits.limit));
    });
    clock.run(options.grow.method == Method::raw ? "prisms" : "growth",
              [&] { make_shell(r, options, thickness_grid, interrupter); });
    clock.run("tets", [&] { r.tets = make_tets(r.shell, r.split); });
    clock.run("certificate", [&] {
        r.report.certificate = certify_shell(r.shell, r.split, prism_test(options), interrupter);
    });
    clock.run("figures", [&] { measure_result(r); });
    clock.run("coverage", [&] {
        r.report.coverage = estimate_coverage(r.surface, r.tets, options.coverage, interrupter);
    });
}

} // namespace

ShellResult build_shell(const TriangleMesh& mesh, const ShellOptions& options,
                        const std::string& name, const openvdb::FloatGrid* thickness_grid,
                        Interrupter* interrupter)
{
    require_a_bound(options, thickness_grid);
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
    require_a_bound(options, thickness_grid);
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
    json["level_set"] = {{"voxel_size", or_null(options.level_set.voxel_size)},
                         {"resolution", options.level_set.resolution},
                         {"exterior_voxels", options.level_set.exterior_voxels},
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
                    {"free_rounds", options.grow.free_rounds}};
    json["split"] = {{"rule", name_in_table(options.split.rule)}, {"seed", options.split.seed}};
    json["coverage"] = {{"samples", options.coverage.samples}, {"seed", options.coverage.seed}};
    return json.dump(2);
}

} // namespace vdb_shell
