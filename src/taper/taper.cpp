// SPDX-License-Identifier: Apache-2.0

// Takes: a certified stack of layers inside a surface. Leaves: a stack with fewer, better shaped
// tets that fill as much, in which vertices share inner points. Each round tries every change of
// four kinds once: merge two points, move a point, hand a vertex over from one point to another,
// turn a diagonal. All of them lower one cost, so rounds end by themselves: when one of them has
// next to nothing left to do, or after as many as the options say (docs/stages/taper.md).

#include "vdb_shell/taper/taper.h"

#include "core/stage_progress.h"
#include "mesh/triangle_area.h"
#include "taper/passes.h"
#include "vdb_shell/options/option.h"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace vdb_shell
{
namespace
{

using namespace taper;

/// The triangles, or the prisms as high as edges are long that the solid would hold, whichever are
/// more. Counted by triangles alone the void is the cheaper the finer the surface is: the scan
/// boot, of six such prisms to a triangle, was filled to .94 instead of .98.
double units_of_solid(const std::vector<openvdb::Vec3s>& points,
                      const std::vector<openvdb::Vec3I>& triangles, double volume)
{
    const auto count = double(triangles.size());
    // The mean of a triangle.
    const double area = surface_area(points, triangles) / count;
    const double edge_if_equilateral = std::sqrt(4 / std::sqrt(3.0) * area);
    return std::max(count, volume / (area * edge_if_equilateral));
}

CostWeights weights_of(const ShellStack& stack, const TaperOptions& options)
{
    CostWeights weights;
    weights.tet = options.tet_cost;
    weights.power = options.shape_power;
    weights.poor = options.poor_cost;
    // The void is what of the solid has no tets, so a cost of the void is a gain of the tets.
    const double solid = std::abs(signed_volume(stack.surface(0), stack.triangles()));
    weights.volume6 = options.void_cost *
                      units_of_solid(stack.surface(0), stack.triangles(), solid) / (6 * solid);
    weights.worst_distortion = distortion_of_amips(options.worst_amips);
    return weights;
}

/// One round; how many changes it made.
std::size_t make_round(Passes& passes, int percent, TaperReport& report)
{
    // Merges leave points where one of the two was, or halfway, and moves take them on from there.
    // Each sweep halves about what is left to win, and a round ends with other points anyhow.
    constexpr int kMoveSweeps = 3;
    const std::size_t before = report.merges + report.moves + report.handed_over + report.turned;
    report.merges += passes.merge(percent);
    for (int i = 0; i < kMoveSweeps; ++i)
        report.moves += passes.move(percent);
    report.handed_over += passes.hand_over(percent);
    report.turned += passes.turn(percent);
    ++report.rounds;
    return report.merges + report.moves + report.handed_over + report.turned - before;
}

void count_result(const TaperState& s, TaperReport& report)
{
    for (int n = s.vertices(); n < static_cast<int>(s.point.size()); ++n)
        report.inner_points += s.used(n);
    for (const PieceCost& cost : s.cost)
        // A prism has three tets at most, none where all its corners are pins.
        ++report.prisms_by_tets[std::size_t(cost.tets)];
}

} // namespace

const NameTable<CoreSurface>& names(CoreSurface)
{
    static const NameTable<CoreSurface> table{{"free", CoreSurface::free},
                                              {"stitched", CoreSurface::stitched}};
    return table;
}

OptionList describe(TaperOptions& o)
{
    return in_group(
        "Taper",
        {option("wanted", o.wanted, "--taper",
                "Let vertices share inner points: fewer and better tets"),
         option("tet_cost", o.tet_cost, "--taper-tet-cost",
                "What a tet costs besides its distortion, which is 1 for a regular tet: the "
                "larger, the fewer tets")
             .within(at_least(0))
             .needing("--taper"),
         option("shape_power", o.shape_power, "--taper-shape-power",
                "Power of the distortion that counts: the larger, the more the worst tets count")
             .within(at_least(1).at_most(8))
             .needing("--taper"),
         option("poor_cost", o.poor_cost, "--taper-poor-cost",
                "What a tet costs besides that SOFA's mesh checks warn of: a dihedral angle under "
                "20 or over 160 degrees, or edges of more than 1 to 10")
             .within(at_least(0))
             .needing("--taper"),
         option("void_cost", o.void_cost, "--taper-void-cost",
                "What the empty solid would cost for each triangle, or for each prism as high as "
                "edges are long that it would hold, if those are more: the larger, the fuller")
             .within(at_least(0))
             .needing("--taper"),
         option("worst_amips", o.worst_amips, "--taper-worst-amips",
                "No change makes a tet of a larger AMIPS, 3 for a regular tet")
             .within(at_least(3))
             .needing("--taper"),
         option("rounds", o.rounds, "--taper-rounds", "Rounds at most")
             .in(Unit::count)
             .within(at_least(1).at_most(1000))
             .needing("--taper"),
         option("core", o.core, "--core",
                "Parts of the inner surface that come close: stay free, or are stitched")});
}

TaperReport taper_shell(ShellStack& stack, const std::vector<double>& cap,
                        const TaperOptions& options, Interrupter* interrupter,
                        const VertexRange& obstacles)
{
    require_in_range(options, "taper");
    assert(stack.skin == 0 && cap.size() == stack.surface(0).size());
    const StageProgress progress(interrupter, "taper");
    const growth::Connectivity mesh = growth::connect(stack.surface(0).size(), stack.triangles());
    TaperState s = make_taper_state(mesh, stack, cap, weights_of(stack, options));
    s.obstacles = obstacles;
    MergeOptions merge;
    // Without stitching, points that face each other across the void stay apart, however near they
    // are.
    merge.across = options.core == CoreSurface::stitched ? merge.across : 0;
    // With one layer a point that joined the surface would be a pin, and thickness lost.
    merge.into_level_above = s.levels > 1;
    // A round that changes fewer than one edge in a hundred is not worth its time.
    const std::size_t few = s.edges.size() / 100;
    TaperReport report;
    Passes passes(s, merge, progress);
    for (int i = 0; i < options.rounds; ++i)
        if (make_round(passes, 100 * i / options.rounds, report) <= few)
            break;
    put_back(s, stack);
    // From here on equal places are one point (shell/shared_points.h), and the certificate is that
    // of tapered shells.
    stack.tapered = true;
    count_result(s, report);
    return report;
}

} // namespace vdb_shell
