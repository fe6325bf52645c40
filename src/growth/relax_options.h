// SPDX-License-Identifier: Apache-2.0
#pragma once

// How long and how hard inner vertices are relaxed, chosen from the schedule by what came before.

#include "growth/grow_state.h"
#include "vdb_shell/growth/grow.h"

#include <cstddef>
#include <vector>

namespace vdb_shell::growth
{

/// What the rounds go on from, which decides how many there are and how hard they push.
enum class StartedFrom {
    lines,     ///< a shell along lines, far from done, or one that was refined
    prolonged, ///< the shell of a coarser surface, nearly done
};

/// What one attempt at a shell asks of its rounds, beside the options.
struct AttemptRounds {
    bool keep_weight = false; ///< RelaxOptions
    double fill_to_beat = 0;  ///< RelaxOptions
};

/// One run of relax(). Gains are shares of the solid, barrier weights are in units of the mean
/// volume of a tet.
struct RelaxOptions {
    int most_rounds = 0;
    /// First trust radii are short, however full the shell is (TrustRadiusSchedule).
    bool short_first_radii = false;
    double first_weight = 0;    ///< of the barrier
    double weight_decrease = 0; ///< factor on it in each round
    /// Except in those after which BarrierSchedule::most_rounds like them would fill all that is
    /// still empty: inner vertices are on their way to where this weight would have them, and one
    /// that falls sooner lets them jam on it.
    bool keep_weight = false;
    double least_gain = 0; ///< of a round at the smallest weight, for another to follow
    /// Ends once the weight is below end_weight and a round has won no more than
    /// end_gain_of_void, a share of what was still empty. A weight of 0 ends nothing.
    double end_weight = 0, end_gain_of_void = 0;
    /// Ends with a round that wins no more than this for each active vertex, whatever the weight.
    /// Below 0 not even a loss ends it: early on a loss is the barrier undoing jams.
    double least_gain_per_vertex = -1;
    /// Ends once the weight is at its least and the rounds that are left, each winning as much as
    /// the last, would leave the shell less full than that. A fill of 0 ends nothing.
    double fill_to_beat = 0;
    /// What a vertex must have won in the round before for it and its neighbours to be active, once
    /// most jams are undone. 0: all are active.
    double active_gain = 0;
    /// While the shell is less full than wanted_fill, rounds go on, whatever the numbers above and
    /// least_gain_per_vertex say, until even with all vertices active one wins no more than
    /// wanted_gain_of_void, a share of what is still empty. What makes a vertex active is then
    /// wanted_active_gain_of_void, a share of what is still empty over the number of vertices. A
    /// fill of 0 wants nothing.
    double wanted_fill = 0, wanted_gain_of_void = 0, wanted_active_gain_of_void = 0;
    /// What each vertex may win in the first round, as six times a volume. Empty: all are active.
    std::vector<double> predicted_gain = {};
};

/// Whether the options want more than the default: thickest, or a number of rounds.
bool asks_for_more(const GrowOptions& options);

/// Rounds that a surface of so many triangles is given after a prolongation, by default.
int affordable_rounds(std::size_t triangles, const GrowthSchedule& schedule);

/// The rounds on a coarse surface, on the way to one of so many triangles. Those from lines under
/// the three-tet test follow others under the twelve-tet test.
RelaxOptions relax_coarse(const GrowState& s, StartedFrom from, std::size_t triangles);

/// The rounds on the surface itself: of a prolonged shell for Method::certified alone.
RelaxOptions relax_whole(const GrowState& s, StartedFrom from, const GrowOptions& options,
                         std::vector<double> predicted_gain, const AttemptRounds& rounds = {});

/// The rounds under the three-tet test, for Method::thickest.
RelaxOptions relax_thickest(const GrowState& s, StartedFrom from, const GrowOptions& options);

} // namespace vdb_shell::growth
