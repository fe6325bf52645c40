// SPDX-License-Identifier: Apache-2.0
#include "pipeline/sides.h"

#include "mesh/triangle_area.h"
#include "step/thickness.h"

#include <openvdb/tools/Count.h>

#include <algorithm>
#include <utility>

namespace vdb_shell
{
namespace
{

/// What the user's thickness allows at most; nothing where it sets no bound.
std::optional<double> longest_line(const LineStepOptions& options,
                                   const openvdb::FloatGrid* thickness_grid)
{
    std::optional<double> longest = options.thickness;
    if (thickness_grid) {
        const double painted = openvdb::tools::minMax(thickness_grid->tree()).max();
        const double background = thickness_grid->background();
        const double deepest = std::max(painted, background);
        if (deepest > 0.0)
            longest = std::min(longest.value_or(deepest), deepest);
    }
    return longest;
}

/// The voxels of a dense field that cost about as much as the lines do in a sparse one. With 71
/// voxels a line (rocker-arm) the sparse way took a quarter of the dense way's time, with 21
/// (cheburashka, 120,000 faces) a third, with 3 (853,000 faces) as much.
double sparse_voxels(std::size_t lines)
{
    constexpr double kVoxelsPerLine = 5;
    return kVoxelsPerLine * static_cast<double>(lines);
}

/// The voxels inside down to the depth of the lines, about.
double dense_voxels(const ShellOptions& options, const TriangleMesh& surface,
                    const openvdb::FloatGrid* thickness_grid)
{
    const double voxel = resolve_voxel_size(surface, options.level_set);
    const double solid = std::abs(signed_volume(surface.points, surface.triangles));
    const std::optional<double> longest = longest_line(options.line_step, thickness_grid);
    const double area = surface_area(surface.points, surface.triangles);
    return std::min(solid, longest ? area * *longest : solid) / std::pow(voxel, 3);
}

/// A side as the stages see it: the surface with that side behind its triangles.
struct SideJob {
    const TriangleMesh& surface;
    const openvdb::FloatGrid& level_set;
    bool sparse; ///< level_set is a narrow band
    const ShellOptions& options;
    const openvdb::FloatGrid* thickness_grid;
    StageClock& clock;
    std::string prefix; ///< of the stages' names
    Interrupter* interrupter;
    const GrowStart& start;
};

/// What the stages of one side make.
struct SideResult {
    SideLines lines;
    ShellStack stack;
    std::optional<GrowReport> grow;
    std::optional<ScaleReport> scale;
};

/// The prisms straight from the lengths: nothing is promised, so nothing is mended.
void make_raw_shell(const SideJob& job, SideResult& side)
{
    LineLengths lengths = side.lines.lengths;
    for (double& length : lengths.length)
        length *= job.options.scale.factor;
    PrismShell shell = extrude(job.surface, side.lines.directions, lengths);
    PrismSplit split = split_prisms(shell, job.options.split);
    side.stack = one_layer(std::move(shell), std::move(split));
}

void grow_and_scale(const SideJob& job, SideResult& side)
{
    const ShellOptions& options = job.options;
    GrowResult grown =
        grow_shell_from(job.start, job.surface, side.lines.directions, side.lines.lengths,
                        largest_lengths(job.surface, options.line_step, job.thickness_grid),
                        options.grow, options.split, job.interrupter);
    side.grow = grown.report;
    if (options.scale.factor < 1.0)
        side.scale = scale_thickness(grown.shell, grown.split, options.scale, prism_test(options),
                                     job.interrupter);
    side.stack = one_layer(std::move(grown.shell), std::move(grown.split));
}

/// Growth that goes on from a shell has no use for lines; a raw shell is made of nothing else.
std::vector<std::uint32_t> vertices_to_step(const SideJob& job)
{
    if (job.options.grow.method == Method::raw)
        return vertices_of_coarsest(job.surface, {});
    return job.start.from == GrowFrom::shell ? std::vector<std::uint32_t>()
                                             : vertices_of_coarsest(job.surface, job.start.levels);
}

SideResult build_side(const SideJob& job)
{
    const ShellOptions& options = job.options;
    SideResult side;
    SideLines& lines = side.lines;
    job.clock.run(job.prefix + "directions", [&] {
        lines.directions = compute_directions(job.surface, job.level_set, options.directions);
    });
    job.clock.run(job.prefix + "line stepping", [&] {
        const auto step = job.sparse ? line_step_sparse : line_step;
        const std::vector<std::uint32_t> only = vertices_to_step(job);
        lines.lengths = step(job.surface, job.level_set, lines.directions, options.line_step,
                             job.thickness_grid, job.interrupter, &only);
    });
    job.clock.run(job.prefix + "limits", [&] {
        apply_limits(lines.lengths,
                     vertex_limits(job.surface, lines.directions, options.limits.limit));
    });
    if (options.grow.method == Method::raw)
        job.clock.run(job.prefix + "prisms", [&] { make_raw_shell(job, side); });
    else
        job.clock.run(job.prefix + "growth", [&] { grow_and_scale(job, side); });
    return side;
}

SideResult build_outside(const ShellResult& result, ShellOptions options,
                         const openvdb::FloatGrid* thickness_grid, StageClock& clock,
                         Interrupter* interrupter)
{
    if (!options.line_step.thickness && !thickness_grid)
        options.line_step.thickness = default_outward_thickness(result.surface);
    const TriangleMesh reversed = reversed_surface(result.surface);
    // In place, for a copy would double the memory.
    negate_level_set(*result.level_set);
    const GrowStart from_lines;
    SideResult side =
        build_side({reversed, *result.level_set, false, options, thickness_grid, clock,
                    options.side == Side::both ? "outward " : "", interrupter, from_lines});
    negate_level_set(*result.level_set);
    side.stack = turn_back(side.stack);
    return side;
}

} // namespace

GrowStart start_of_growth(const ShellOptions& options, const TriangleMesh& surface)
{
    if (options.grow.method == Method::raw || options.side == Side::outward)
        return {};
    return {GrowFrom::levels, {}, coarse_levels(surface, options.grow)};
}

std::string why_not_sparse(const ShellOptions& options, const ShellResult& result,
                           const GrowStart& start, const openvdb::FloatGrid* thickness_grid)
{
    if (options.field == FieldRoute::dense)
        return "it was asked for";
    if (options.side != Side::inward)
        return "lines outward";
    if (options.smooth.iterations > 0)
        return "smoothing";
    // The narrow band is as wide inside as outside.
    constexpr double kWidestBandVoxels = 8;
    if (options.level_set.exterior_voxels > kWidestBandVoxels)
        return "a wide band outside";
    if (options.level_set.interior_depth || options.level_set.exterior_depth)
        return "a band of the depth asked for";
    if (result.report.mesh.self_intersections.count > 0)
        return "a surface that crosses itself";
    if (options.field == FieldRoute::automatic &&
        sparse_voxels(
            (start.levels.empty() ? result.surface : start.levels.back().mesh).points.size()) >
            dense_voxels(options, result.surface, thickness_grid))
        return "many lines";
    return "";
}

LevelSetOptions band_for(const ShellOptions& options, const TriangleMesh& surface,
                         const openvdb::FloatGrid* thickness_grid)
{
    LevelSetOptions band = options.level_set;
    const std::optional<double> longest = longest_line(options.line_step, thickness_grid);
    if (options.side != Side::inward && !band.exterior_depth) {
        band.exterior_depth = longest;
        if (!longest && !thickness_grid)
            band.exterior_depth = default_outward_thickness(surface);
    }
    if (!band.interior_depth)
        // The stencil of the vertices is all that lines outward read inside.
        band.interior_depth =
            options.side == Side::outward ? resolve_voxel_size(surface, band) : longest;
    return band;
}

PrismTest prism_test(const ShellOptions& options)
{
    return options.grow.method == Method::thickest ? PrismTest::chosen_tets
                                                   : PrismTest::twelve_tets;
}

void build_sides(ShellResult& result, const ShellOptions& options,
                 const openvdb::FloatGrid* thickness_grid, StageClock& clock,
                 Interrupter* interrupter, const GrowStart& start)
{
    result.report.side = options.side;
    SideResult main =
        options.side == Side::outward
            ? build_outside(result, options, thickness_grid, clock, interrupter)
            : build_side({result.surface, *result.level_set, result.report.field.sparse, options,
                          thickness_grid, clock, "", interrupter, start});
    result.directions = std::move(main.lines.directions);
    result.lengths = std::move(main.lines.lengths);
    result.report.grow = main.grow;
    result.report.scale = main.scale;
    result.stack = std::move(main.stack);
    if (options.side != Side::both)
        return;
    SideResult outside = build_outside(result, options, thickness_grid, clock, interrupter);
    result.report.outside = {{}, outside.grow, outside.scale};
    result.outside = std::move(outside.lines);
    result.stack = join_sides(std::move(outside.stack), std::move(result.stack));
}

} // namespace vdb_shell
