// SPDX-License-Identifier: Apache-2.0

// Takes: a certified stack and what the user wants of it. Leaves: the stack tapered, by the costs
// that came nearest. Tapering minimises a sum of costs and knows no bounds, so what falls short is
// made dearer and it is run again, from the same stack: tets by a bisection once both sides of the
// budget have been seen with the same other costs, the void and the distortion by a factor. A run
// that has all ends it; of several that have not, the one that misses fewest bounds, and those by
// least, is kept. All by counts and sums in index order, so the choice is the same for any number
// of threads.

#include "pipeline/taper_to_bounds.h"

#include "vdb_shell/core/error.h"

#include "pipeline/core_stages.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>

namespace vdb_shell
{
namespace
{

// What one run changes. Of --for simulation's costs a third as many tets more or less follow from
// three times the cost of a tet, and the void's cost has to double to show at all.
constexpr double kTetFactor = 3, kVoidFactor = 2.5, kPowerStep = 0.5, kMostPower = 4;

/// The next costs to try. `many` and `few`: the latest cost of a tet that gave too many, and that
/// gave few enough, with the other costs as they are now.
struct Search {
    TaperOptions costs;
    std::optional<double> many, few;

    void heed(const BoundsReport& judged)
    {
        const TaperOptions before = costs;
        for (const WantedBound& bound : judged.bounds)
            heed_fill_or_shape(bound);
        const bool others_changed =
            costs.void_cost != before.void_cost || costs.shape_power != before.shape_power;
        for (const WantedBound& bound : judged.bounds)
            if (bound.kind == BoundKind::tets)
                heed_tets(bound.met, others_changed);
    }

private:
    void heed_fill_or_shape(const WantedBound& bound)
    {
        if (bound.met || bound.kind == BoundKind::tets)
            return;
        if (bound.kind == BoundKind::fill)
            costs.void_cost = kVoidFactor * std::max(costs.void_cost, 1.0);
        else
            // The more the worst tets count the fewer of them are left.
            costs.shape_power = std::min(kMostPower, costs.shape_power + kPowerStep);
    }
    void heed_tets(bool met, bool others_changed)
    {
        // How many tets a cost gives depends on the other costs, so with others it says nothing.
        if (others_changed)
            many = few = std::nullopt;
        else
            (met ? few : many) = costs.tet_cost;
        if (many && few)
            // Where tets are few enough but another bound is missed, some more of them may help.
            costs.tet_cost = std::sqrt(*many * *few);
        else if (!met)
            costs.tet_cost = kTetFactor * std::max(costs.tet_cost, 1.0);
    }
};

/// A shape that only the surface stands in the way of cannot be had by other costs.
bool worth_another_run(const BoundsReport& judged)
{
    return std::any_of(judged.bounds.begin(), judged.bounds.end(), [](const WantedBound& b) {
        const std::size_t by_surface = b.causes[std::size_t(ShortCause::surface_triangle)] +
                                       b.causes[std::size_t(ShortCause::surface_edge)];
        return !b.met && (b.short_tets == 0 || by_surface < b.short_tets);
    });
}

} // namespace

void taper_to_bounds(ShellResult& r, const ShellOptions& options, const std::vector<double>& cap,
                     Interrupter* interrupter)
{
    const ShellStack untapered = r.stack;
    Search search{options.taper, {}, {}};
    if (options.wanted.amips)
        search.costs.worst_amips = std::min(search.costs.worst_amips, *options.wanted.amips);
    std::optional<double> best;
    std::size_t runs = 0;
    for (bool more = true; more;) {
        ShellStack stack = untapered;
        TaperReport report = taper_shell(stack, cap, search.costs, interrupter, r.core_vertices);
        report.runs = ++runs;
        if (!options.wanted.any()) {
            r.stack = std::move(stack);
            r.report.taper = report;
            return;
        }
        const BoundsReport judged =
            judge_bounds(stack, make_tets(stack), r.surface, options.side, cap, options.wanted);
        if (!best || judged.shortfall() < *best) {
            best = judged.shortfall();
            r.stack = std::move(stack);
            r.report.taper = report;
        }
        search.heed(judged);
        more = worth_another_run(judged) && runs < kMostTaperRuns;
    }
    r.report.taper->runs = runs;
}

void judge_result(ShellResult& r, const ShellOptions& options, const std::vector<double>& cap)
{
    // Where there are cores, what is to be filled is the solid between.
    if (options.wanted.any())
        r.report.wanted =
            judge_bounds(r.stack, r.tets, solid_to_fill(r), options.side, cap, options.wanted);
}

void require_enough_tets(const TriangleMesh& surface, const WantedBounds& wanted)
{
    if (wanted.tets && *wanted.tets < surface.triangles.size())
        throw InvalidOption("want: tets is " + std::to_string(*wanted.tets) +
                            " (--want-tets), but the surface has " +
                            std::to_string(surface.triangles.size()) +
                            " triangles with a tet each; --remesh-to and --decimate-to make fewer");
}

} // namespace vdb_shell
