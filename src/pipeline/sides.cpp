// SPDX-License-Identifier: Apache-2.0

// Takes: the surface, its level set and the options. Leaves: lines, shell and their reports, for
// one side of the surface or for both. The stages know of one side only, the one behind the
// triangles in a field that is negative there; for the other side they get the reversed surface and
// the negated field (docs/theory.md, "Outward shells, and shells on both sides"). It is also
// decided here which field the lines need: how deep, and whether a narrow band will do. Such
// decisions change time and memory, but no proof: lines only propose lengths.

#include "pipeline/sides.h"

#include "core/grid_instances.h"
#include "field/value_range.h"
#include "mesh/triangle_area.h"
#include "step/thickness.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace vdb_shell
{
namespace
{

/// What the user's thickness allows at most; nothing where it sets no bound. A painted grid is
/// sampled outside its active voxels too, where it has its background, so that counts as well. In
/// world units.
std::optional<double> longest_line(const LineStepOptions& options,
                                   const openvdb::FloatGrid* thickness_grid)
{
    std::optional<double> longest = options.thickness;
    if (thickness_grid) {
        const double painted = value_range(*thickness_grid).greatest;
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

/// An estimate of the voxels inside, down to the depth of the lines. It only has to tell which of
/// two ways is less work.
double dense_voxels(const ShellOptions& options, const TriangleMesh& surface,
                    const openvdb::FloatGrid* thickness_grid)
{
    const double voxel = resolve_voxel_size(surface, options.level_set);
    // Both bounds hold: there are no more voxels than the solid has, and a layer along the surface
    // has about area times depth.
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
    VertexRange cores{}; ///< vertices that stay pinned
};

/// What the stages of one side make.
struct SideResult {
    SideLines lines;
    ShellStack stack;
    std::optional<GrowReport> grow;
    std::optional<ScaleReport> scale;
};

/// The prisms straight from the lengths. The raw method is the paper's, for comparison: nothing is
/// promised, so nothing is mended, and the scale is applied to the lengths without any test.
void make_raw_shell(const SideJob& job, SideResult& side)
{
    LineLengths lengths = side.lines.lengths;
    for (double& length : lengths.length)
        length *= job.options.scale.factor;
    PrismShell shell = extrude(job.surface, side.lines.directions, lengths);
    PrismSplit split = split_prisms(shell, job.options.split);
    side.stack = one_layer(std::move(shell), std::move(split));
}

/// The user's bounds on the pillars; those of cores have no length.
std::vector<double> caps_of(const SideJob& job)
{
    std::vector<double> cap =
        largest_lengths(job.surface, job.options.line_step, job.thickness_grid);
    std::fill_n(cap.begin() + std::ptrdiff_t(job.cores.first), job.cores.count, 0.0);
    return cap;
}

void grow_and_scale(const SideJob& job, SideResult& side)
{
    const ShellOptions& options = job.options;
    GrowResult grown =
        grow_shell_from(job.start, job.surface, side.lines.directions, side.lines.lengths,
                        caps_of(job), options.grow, options.split, job.interrupter);
    side.grow = grown.report;
    if (options.scale.factor < 1.0)
        side.scale = scale_thickness(grown.shell, grown.split, options.scale,
                                     prism_test_of(options.grow), job.interrupter);
    side.stack = one_layer(std::move(grown.shell), std::move(grown.split));
}

/// Growth that goes on from a shell reads no lengths of lines, and growth on levels those of the
/// coarsest surface only; a raw shell is made of all of them.
std::vector<std::uint32_t> vertices_to_step(const SideJob& job)
{
    if (job.options.grow.method == Method::raw)
        return vertices_of_coarsest(job.surface, {});
    return job.start.from == GrowFrom::shell ? std::vector<std::uint32_t>()
                                             : vertices_of_coarsest(job.surface, job.start.levels);
}

/// The coarsest surface that is the same to voxels: the one that distances are measured to beyond
/// the narrow band. A tree over ten million triangles takes longer than all that lines ask it.
const TriangleMesh& surface_from_afar(const SideJob& job)
{
    // In the mean; distances are then off by a few hundredths of a voxel.
    constexpr double kEdgeVoxels = 0.5;
    const TriangleMesh* coarsest = &job.surface;
    if (job.start.levels.empty())
        return *coarsest;
    // Of an equilateral triangle the area is sqrt(3) / 4 times its edge squared.
    const double longest = kEdgeVoxels * job.level_set.voxelSize()[0],
                 most_area = 0.25 * std::sqrt(3.0) * longest * longest,
                 area = surface_area(job.surface.points, job.surface.triangles);
    for (const Coarsened& level : job.start.levels)
        if (area <= most_area * double(level.mesh.triangles.size()))
            coarsest = &level.mesh;
    return *coarsest;
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
        // A narrow band is read by the sparse stepper alone: the other one would take its inner rim
        // for the deepest that lines can go.
        const std::vector<std::uint32_t> only = vertices_to_step(job);
        lines.lengths =
            job.sparse ? line_step_sparse(job.surface, job.level_set, lines.directions,
                                          options.line_step, job.thickness_grid, job.interrupter,
                                          &only, &surface_from_afar(job))
                       : line_step(job.surface, job.level_set, lines.directions, options.line_step,
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
    // In place, for a copy would double the memory; twice negated, every bit is as before. If a
    // stage throws in between, the field stays negated, but then there is no result that holds it.
    negate_level_set(*result.level_set);
    // Coarser surfaces are for a side with bounds; outside, growth begins with the lines of the
    // surface itself.
    const GrowStart from_lines;
    SideResult side =
        build_side({reversed, *result.level_set, false, options, thickness_grid, clock,
                    options.side == Side::both ? "outward " : "", interrupter, from_lines});
    negate_level_set(*result.level_set);
    side.stack = turn_back(side.stack);
    return side;
}

} // namespace

GrowStart start_of_growth(const ShellOptions& options, const TriangleMesh& surface,
                          Interrupter* interrupter)
{
    if (options.grow.method == Method::raw || options.side == Side::outward)
        return {};
    return {GrowFrom::levels, {}, coarse_levels(surface, options.grow, interrupter)};
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
    // The narrow band is as wide inside as outside, so a wide one outside would be computed inside
    // as well.
    constexpr double kWidestBandVoxels = 8;
    if (options.level_set.exterior_voxels > kWidestBandVoxels)
        return "a wide band outside";
    if (options.level_set.interior_depth || options.level_set.exterior_depth)
        return "a band of the depth asked for";
    // The signs of the narrow band come from the nearest triangle alone, which is not enough where
    // the surface crosses itself.
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
        // Lines outward read nothing inside but the stencils of their first points, so one voxel of
        // depth is enough, with the spare voxels that every band gets.
        band.interior_depth =
            options.side == Side::outward ? resolve_voxel_size(surface, band) : longest;
    return band;
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
                          thickness_grid, clock, "", interrupter, start, result.core_vertices});
    result.directions = std::move(main.lines.directions);
    result.lengths = std::move(main.lines.lengths);
    // For both sides the main report is that of the side inside, and the other one stands apart.
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
