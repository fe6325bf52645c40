// SPDX-License-Identifier: Apache-2.0

// Describes the options of growth and of refinement, each field once: the command line, files of
// options, the validation, the help and Houdini's node are made of these lists (docs/options.md).
// Nothing is decided here. Default values stand in the structs, not in these texts, except where a
// field may be unset. The keys and flags are in users' scripts and in stored files.

#include "vdb_shell/growth/grow.h"
#include "vdb_shell/growth/refine.h"
#include "vdb_shell/options/option.h"

namespace vdb_shell
{

const NameTable<Method>& names(Method)
{
    static const NameTable<Method> table{
        {"raw", Method::raw}, {"certified", Method::certified}, {"thickest", Method::thickest}};
    return table;
}

PrismTest prism_test_of(const GrowOptions& options)
{
    return options.method == Method::thickest ? PrismTest::chosen_tets : options.prism_test;
}

const NameTable<RefineBy>& names(RefineBy)
{
    static const NameTable<RefineBy> table{
        {"contacts", RefineBy::contacts}, {"voids", RefineBy::voids}, {"area", RefineBy::area}};
    return table;
}

OptionList describe(GrowOptions& o)
{
    return in_group(
        "Growth",
        {option("method", o.method, "--method", "How the inner vertices get their places")
             .with_shorthand("--thickest", "thickest"),
         option("prism_test", o.prism_test, "--prism-test",
                "Tets of each prism that stay positive: all twelve of its six splits, for layers, "
                "thinner shells and coordinates; or the three chosen ones, sooner and fuller")
             .needing("--method certified"),
         option("mend_directions", o.mend_directions, "--mend-directions",
                "Replace directions that see a triangle from behind"),
         option("smooth_directions", o.smooth_directions, "--smooth-directions",
                "Smooth the directions across faces, not across creases"),
         option("top_down", o.top_down, "--top-down",
                "Start from long lines, made valid, instead of a thin shell; a small surface that "
                "is far from full then is grown from other starts too"),
         option("grow_lines", o.grow_lines, "--grow-lines",
                "Lengthen along the lines where the start is nearly full"),
         option("free_moves", o.free_moves, "--free-moves", "Let inner vertices leave their lines"),
         option("soft_contacts", o.soft_contacts, "--soft-contacts",
                "Keep clear of near triangles before they touch"),
         option("flips", o.flips, "--flips",
                "Turn diagonals for room and for quality; prisms that fail get others anyway"),
         option("coarse_from", o.coarse_from, "--coarse-from",
                "Triangles from which on growth begins on a coarser surface; 0: never")
             .needing("--method certified thickest")
             .in(Unit::count),
         // May be unset, which is not the same as 40: then growth on a prolonged shell ends as soon
         // as a round wins little for its cost.
         option("free_rounds", o.free_rounds, "--free-rounds",
                "Upper bound on rounds of free moves [40; after a coarser surface as many as pay]")
             .needing("--method certified thickest")
             .in(Unit::count)
             .within(at_least(0)),
         option("enough_fill", o.enough_fill, "--enough-fill",
                "End growth at this fill, 0 to 1, and go on for it while rounds win something "
                "[0.998; after a coarser surface go on for 0.9855]")
             .needing("--method certified thickest")
             .in(Unit::share)
             .within(above(0).at_most(1)),
         option("min_quality", o.min_quality, "--min-quality",
                "Mean ratio that tets should reach, at a cost in thickness; 0 asks for none")
             .needing("--method certified thickest")
             .within(at_least(0).below(1)),
         option("stop_reasons", o.stop_reasons, "--stop-reasons",
                "Ask each vertex what holds it back, for the report")
             .needing("--method certified thickest")});
}

OptionList describe(RefineOptions& o)
{
    // All other fields say how the rounds go, so they have no meaning without rounds.
    const std::string rounds = "--refine-rounds";
    return in_group(
        "Resampling",
        {option("rounds", o.rounds, rounds,
                "Rounds of cutting triangles where the shell is held back, and growing on")
             .in(Unit::count)
             .within(at_least(0)),
         option("by", o.by, "--refine-by", "What makes a triangle worth cutting").needing(rounds),
         option("share", o.share, "--refine-share",
                "Share of that in the triangles cut in one round, those most worth it first")
             .in(Unit::share)
             .within(above(0).at_most(1))
             .needing(rounds),
         option("max_tets", o.max_tets, "--max-tets", "Refine to no more tets than this")
             .in(Unit::count)
             .needing(rounds),
         option("target_fill", o.target_fill, "--target-fill",
                "End refinement at this fill, 0 to 1")
             .in(Unit::share)
             .within(above(0).at_most(1))
             .needing(rounds),
         option("min_gain", o.min_gain, "--refine-min-gain",
                "End refinement when a round gains less fill than this")
             .in(Unit::share)
             .within(at_least(0).at_most(1))
             .needing(rounds)});
}

void require_sensible(const RefineOptions& options)
{
    require_in_range(options, "refine");
}

} // namespace vdb_shell
