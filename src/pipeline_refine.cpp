// SPDX-License-Identifier: Apache-2.0
#include "pipeline_refine.h"

#include "pipeline_sides.h"

#include <limits>
#include <utility>

namespace vdb_shell
{
namespace
{

/// Tets that one triangle stands for, pinned corners aside.
std::size_t tets_per_triangle(const ShellOptions& options)
{
    const std::size_t sides = options.side == Side::both ? 2 : 1;
    return 3 * sides * static_cast<std::size_t>(options.layers.layers);
}

std::size_t most_triangles(const ShellOptions& options)
{
    if (!options.refine.max_tets)
        return std::numeric_limits<std::size_t>::max();
    return *options.refine.max_tets / tets_per_triangle(options);
}

/// The layer under the surface: the one whose voids refinement can fill.
const PrismShell& inward_layer(const ShellResult& result)
{
    return result.stack.layers.back();
}

RefineRound figures_of(const ShellResult& result, const ShellOptions& options)
{
    RefineRound round;
    round.triangles = result.surface.triangles.size();
    // Layers are cut later, each into as many tets.
    round.tets =
        make_tets(result.stack).tets.size() * static_cast<std::size_t>(options.layers.layers);
    const double solid = signed_volume(result.surface.points, result.surface.triangles);
    round.fill = tet_volume(make_tets(inward_layer(result), result.stack.splits.back())) / solid;
    return round;
}

/// Why no further round is made; nothing when one is.
std::optional<RefineEnd> end_of(const RefineReport& report, const RefineOptions& options)
{
    const RefineRound& last = report.rounds.back();
    const std::size_t made = report.rounds.size() - 1;
    if (options.target_fill && last.fill >= *options.target_fill)
        return RefineEnd::target_fill;
    if (made > 0 && options.min_gain > 0 &&
        last.fill - report.rounds[made - 1].fill < options.min_gain)
        return RefineEnd::small_gain;
    if (made == static_cast<std::size_t>(options.rounds))
        return RefineEnd::rounds;
    return std::nullopt;
}

/// Cuts triangles of the surface; false when none could be cut.
bool cut_triangles(ShellResult& result, const ShellOptions& options, RefineReport& report,
                   Interrupter* interrupter)
{
    const std::vector<double> worth = refinement_worth(inward_layer(result), options.refine.by);
    RefinedMesh refined =
        refine_triangles(result.surface, triangles_to_cut(worth, options.refine.share),
                         most_triangles(options), interrupter);
    report.rounds.back().cut = refined.taken;
    report.rounds.back().barred_edges = refined.barred_edges;
    if (refined.split_edges == 0) {
        const bool full = result.surface.triangles.size() + 2 > most_triangles(options);
        report.end = full ? RefineEnd::max_tets : RefineEnd::nothing;
        return false;
    }
    result.surface = std::move(refined.mesh);
    return true;
}

RefineReport refine(ShellResult& result, const ShellOptions& options,
                    const openvdb::FloatGrid* thickness_grid, Interrupter* interrupter)
{
    RefineReport report;
    report.rounds.push_back(figures_of(result, options));
    ShellResult best = result;
    while (true) {
        if (const std::optional<RefineEnd> end = end_of(report, options.refine)) {
            report.end = *end;
            break;
        }
        if (!cut_triangles(result, options, report, interrupter))
            break;
        std::vector<StageCost> costs;
        StageClock clock(costs);
        build_sides(result, options, thickness_grid, clock, interrupter);
        report.rounds.push_back(figures_of(result, options));
        if (report.rounds.back().fill <= report.rounds[report.kept].fill)
            continue;
        report.kept = report.rounds.size() - 1;
        best = result;
    }
    result = std::move(best);
    return report;
}

} // namespace

void build_and_refine(ShellResult& result, const ShellOptions& options,
                      const openvdb::FloatGrid* thickness_grid, StageClock& clock,
                      Interrupter* interrupter)
{
    build_sides(result, options, thickness_grid, clock, interrupter);
    if (options.refine.rounds == 0)
        return;
    clock.run("refine", [&] {
        const RefineReport report = refine(result, options, thickness_grid, interrupter);
        result.report.refine = report;
        if (report.kept > 0)
            result.report.mesh = check_mesh(result.surface);
    });
}

} // namespace vdb_shell
