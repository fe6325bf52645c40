// SPDX-License-Identifier: Apache-2.0

// Takes: the finished shell with its lines, tets and field. Leaves: the figures of the report
// filled in, coverage aside. Everything is measured on the float32 that will be written, after the
// last stage that could change them, so a figure cannot speak of another shell than the file does.
// All is computed in doubles and decides nothing; what is proven stands in the certificate. Sums
// run in index order. Lengths and volumes are in world units, unless a name says voxels.

#include "pipeline/figures.h"

#include "core/grid_instances.h"
#include "core/parallel.h"
#include "core/stage_progress.h"
#include "field/value_range.h"
#include "mesh/most_visible.h"
#include "mesh/surface_defects.h"

#include <algorithm>
#include <numeric>

namespace vdb_shell
{
namespace
{

void measure_field(FieldReport& report, const openvdb::FloatGrid& level_set)
{
    report.voxel_size = level_set.voxelSize()[0];
    report.active_voxels = level_set.activeVoxelCount();
    report.memory_bytes = level_set.memUsage();
    // The field is negative inside, so the deepest voxel is the smallest; where no voxel
    // centre lies inside there is none.
    report.interior_depth = std::max(0.0, -double(value_range(level_set).least));
}

std::vector<double> lengths_of(const PrismShell& shell)
{
    std::vector<double> lengths(shell.outer.size());
    for (std::size_t v = 0; v < lengths.size(); ++v)
        lengths[v] = shell.length(v);
    return lengths;
}

std::size_t zeros_in(const std::vector<double>& lengths)
{
    return static_cast<std::size_t>(std::count(lengths.begin(), lengths.end(), 0.0));
}

/// The pillars between two surfaces of a stack, and why they end.
PrismShell pillars_between(const ShellStack& stack, std::size_t first, std::size_t last,
                           const std::vector<StopReason>& stop)
{
    return {stack.surface(first), stack.surface(last), stack.triangles(), stop};
}

void measure_lines(LineReport& report, const Directions& directions, const LineLengths& lines,
                   const PrismShell& hull, double voxel_size)
{
    const std::vector<double>& visibility = directions.visibility;
    report.min_visibility = *std::min_element(visibility.begin(), visibility.end());
    report.blind_vertices = static_cast<std::size_t>(
        std::count_if(visibility.begin(), visibility.end(), [](double v) { return v <= 0.0; }));
    // Lines that were stepped. Growth that begins on coarser surfaces needs those of a few vertices
    // only, and the others have the reason none.
    report.lines = lines.reason.size() -
                   static_cast<std::size_t>(
                       std::count(lines.reason.begin(), lines.reason.end(), StopReason::none));
    report.steps = std::accumulate(lines.steps.begin(), lines.steps.end(), std::size_t(0));
    // These are the reasons after growth, if there was one: they tell what holds the pillar, and
    // not what ended its line.
    for (const StopReason reason : hull.stop)
        ++report.stops[static_cast<std::size_t>(reason)];

    std::vector<double> lengths = lengths_of(hull);
    report.stuck_vertices = zeros_in(lengths);
    report.length = spread_of(lengths);
    for (double& length : lengths)
        length /= voxel_size;
    report.length_voxels = spread_of(std::move(lengths));
}

TetMesh tets_of_layer(const TetMesh& all, std::size_t layer)
{
    TetMesh part;
    part.points = all.points;
    for (std::size_t t = 0; t < all.tets.size(); ++t)
        if (all.prism_layer[t] == layer)
            part.tets.push_back(all.tets[t]);
    return part;
}

LayerFigures measure_layer(const PrismShell& layer, const TetMesh& tets)
{
    LayerFigures figures;
    const std::vector<double> lengths = lengths_of(layer);
    figures.tets = tets.tets.size();
    figures.pinned_vertices = zeros_in(lengths);
    figures.volume = tet_volume(tets);
    figures.length = spread_of(lengths);
    figures.quality = measure_quality(tets);
    return figures;
}

/// Each side has lines of its own, and its pillars end at the skin. For one side alone the hull is
/// that side; for both the hull's pillars run through the skin and have no single line.
void measure_sides(ShellResult& result)
{
    ShellReport& report = result.report;
    const ShellStack& stack = result.stack;
    const double voxel_size = report.field.voxel_size;
    if (!result.outside) {
        measure_lines(report.lines, result.directions, result.lengths, hull_of(stack), voxel_size);
        return;
    }
    measure_lines(report.lines, result.directions, result.lengths,
                  pillars_between(stack, stack.skin, stack.layers.size(), stack.layers.back().stop),
                  voxel_size);
    measure_lines(report.outside->lines, result.outside->directions, result.outside->lengths,
                  pillars_between(stack, 0, stack.skin, stack.layers.front().stop), voxel_size);
}

/// Which pins had to be, and where so many are together that a triangle has no tet.
void judge_pins(ShellReport& report, const ShellStack& stack, const TetMesh& tets)
{
    const TriangleMesh skin = skin_surface(stack);
    const std::vector<std::uint32_t> demanded = blind_vertices(skin);
    report.demanded_pins = summary_of(demanded);
    std::vector<char> has_tet(skin.triangles.size()), blind(skin.points.size());
    for (const std::uint32_t t : tets.prism)
        has_tet[t] = 1;
    for (const std::uint32_t v : demanded)
        blind[v] = 1;
    for (std::uint32_t t = 0; t < has_tet.size(); ++t) {
        if (has_tet[t])
            continue;
        const openvdb::Vec3I& c = skin.triangles[t];
        add_to(report.triangles_without_tet, t);
        report.without_tet_demanded += blind[c[0]] && blind[c[1]] && blind[c[2]];
    }
}

double volume_outside(const ShellStack& stack, const TetMesh& tets, double all)
{
    // With one side the answer is nothing or all, without a further sum; so the fill of an inward
    // shell is that of its tets to the last bit.
    if (stack.skin == 0 || stack.skin == stack.layers.size())
        return stack.skin == 0 ? 0.0 : all;
    double volume = 0;
    for (std::size_t k = 0; k < stack.skin; ++k)
        volume += tet_volume(tets_of_layer(tets, k));
    return volume;
}

} // namespace

void measure_result(ShellResult& result, Interrupter* interrupter)
{
    const StageProgress progress(interrupter, "figures");
    ShellReport& report = result.report;
    measure_field(report.field, *result.level_set);
    const ShellStack& stack = result.stack;
    report.prisms = stack.layers.size() * stack.triangles().size();
    report.pinned_vertices = zeros_in(lengths_of(hull_of(stack)));
    report.ripples = stack.splits.front().ripples;
    // Both jobs are serial in part, so they fill each other's gaps. They write different fields of
    // the report, and neither reads what the other writes.
    run_together([&] { report.conformity = check_conformity(stack, result.tets); },
                 [&] {
                     report.signs = count_tet_signs(result.tets);
                     report.quality = measure_quality(result.tets);
                     report.surface_bounds = measure_surface_bounds(result.surface, report.side);
                     judge_pins(report, stack, result.tets);
                     measure_sides(result);
                 });
    report.solid_volume = signed_volume(result.surface.points, result.surface.triangles);
    if (report.cores)
        report.solid_volume -= report.cores->volume;
    report.shell_volume = tet_volume(result.tets);
    report.outside_volume = volume_outside(stack, result.tets, report.shell_volume);
    report.fill = (report.shell_volume - report.outside_volume) / report.solid_volume;
    for (std::size_t k = 0; stack.layers.size() > 1 && k < stack.layers.size(); ++k)
        report.layers.push_back(measure_layer(stack.layers[k], tets_of_layer(result.tets, k)));
}

} // namespace vdb_shell
