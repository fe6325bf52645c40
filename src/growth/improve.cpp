// SPDX-License-Identifier: Apache-2.0

// Takes: a valid shell whose vertices have come to rest. Leaves: a valid shell with diagonals
// chosen for the shape of the tets, better tets where the user wants them at a cost in thickness,
// and the reason that holds each vertex back, for the report. Diagonals come before the moves,
// since a turned diagonal costs no thickness.

#include "growth/improve.h"

#include "core/parallel.h"
#include "growth/diagonals.h"
#include "growth/raise_quality.h"
#include "growth/stops.h"

#include <cstddef>
#include <utility>

namespace vdb_shell::growth
{
namespace
{

/// Under the twelve-tet test any rule of the user's will do; otherwise growth has its own orders.
bool may_turn_diagonals(const GrowState& s, const GrowOptions& options, const SplitOptions& split)
{
    return options.flips && (!s.twelve || split.rule == SplitRule::length_descending);
}

/// Rules go by the indices that vertices have in the user's mesh.
PrismSplit split_by_rule(const PrismShell& shell, const MeshOrder& order, const SplitOptions& split)
{
    if (order.own())
        return split_prisms(shell, split);
    PrismSplit by_rule = split_prisms(shell_out_of_order(shell, order), split);
    by_rule.order = values_at(by_rule.order, order.triangles);
    return by_rule;
}

/// Settles the diagonals. Gives back the ripples of the user's rule: inconsistencies that it could
/// not resolve.
std::size_t choose_diagonals(GrowState& s, const TriangleMesh& mesh, const MeshOrder& order,
                             const GrowOptions& options, const SplitOptions& split,
                             GrowReport& report)
{
    PrismSplit by_rule;
    if (s.twelve) {
        // The rule looks at lengths, which moves have changed since the last time.
        by_rule = split_by_rule(shell_of(mesh, s), order, split);
        s.order = order_indices(by_rule.order);
    }
    if (may_turn_diagonals(s, options, split))
        report.flips += flip_for_quality(s);
    return by_rule.ripples;
}

void hold_to_quality(GrowState& s, const GrowOptions& options, const SplitOptions& split,
                     const StageProgress& progress, GrowReport& report)
{
    const QualityResult raised =
        raise_quality(s, options.min_quality, may_turn_diagonals(s, options, split), progress);
    report.quality_rounds = raised.rounds;
    report.flips += raised.flips;
    report.tets_below_quality = raised.tets_below;
    report.vertices_below_quality = raised.vertices_below;
}

PrismSplit split_of(const GrowState& s, std::size_t ripples)
{
    PrismSplit split;
    split.ripples = ripples;
    for (const std::uint8_t order : s.order)
        split.order.push_back(tables().order[order]);
    return split;
}

} // namespace

Improved improve(GrowState& s, const TriangleMesh& mesh, const MeshOrder& order,
                 const GrowOptions& options, const SplitOptions& split,
                 const StageProgress& progress, GrowReport& report)
{
    Improved improved;
    std::size_t ripples = 0;
    const auto choose = [&] { ripples = choose_diagonals(s, mesh, order, options, split, report); };
    const auto probe = [&] {
        improved.stop = options.stop_reasons ? probe_stops(s) : plain_stops(s);
    };
    if (s.twelve && !(options.min_quality > 0)) {
        // With all twelve tets tested the stops do not depend on the diagonals.
        run_together(choose, probe);
    } else {
        // Here the tets that hold a vertex depend on the diagonals, so the stops come last.
        choose();
        if (options.min_quality > 0)
            hold_to_quality(s, options, split, progress, report);
        probe();
    }
    improved.split = split_of(s, ripples);
    return improved;
}

} // namespace vdb_shell::growth
