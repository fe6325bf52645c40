// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/stage_progress.h"
#include "growth/grow_state.h"
#include "vdb_shell/growth/grow.h"

namespace vdb_shell::growth
{

/// First weight of the barrier, in units of the mean volume per tet. Under the twelve-tet test a
/// stiff start spreads the inner vertices; under the three-tet test it would only undo what is
/// reached, and traps.
inline constexpr double kTwelveSoftness = 1.0;
inline constexpr double kThreeSoftness = 0.02;

/// Of the solid. From here on the inner surface has collapsed, in one direction at least: lines
/// finish what the start began sooner than free moves do, which set out in short steps.
inline constexpr double kNearlyFull = 0.9;

struct FreeStage {
    int rounds;        ///< upper bound
    double softness;   ///< at the first round
    double cool;       ///< factor on it per round: the slower, the thicker and the longer
    double least_gain; ///< share of the solid that a round must win to go on, at the end
    /// Ends as soon as the weight is below the first, units of softness, and a round has won no
    /// more than the second, share of the solid, for each vertex asked.
    double until = 0, until_gain = 0;
    /// Share of the solid, for each vertex asked: ends with a round that wins less, whatever the
    /// weight. Below 0 not even a loss ends it: early on that is the barrier undoing jams.
    double enough = -1;
    /// Share of the solid: only vertices that won more in the round before, and those beside them,
    /// are asked, once most jams are undone; in a round's later sweeps those that have won a part
    /// of that. 0: all are.
    double worth = 0;
    /// What each is to win in the first round, as volume6. Empty: all are asked.
    std::vector<double> hope = {};
};

/// Inner vertices leave their lines: each minimises the inner volume with an interior barrier on
/// the tets around it and on the walls in front of near triangles, and every move is tested exactly
/// before it is made.
/// Never ends with less fill than it began with. Adds to the report's rounds and flips.
/// Pinned vertices of positive `visibility` are tried again on the way.
void move_freely(GrowState& s, const std::vector<double>& visibility, const GrowOptions& options,
                 const FreeStage& stage, const StageProgress& progress, GrowReport& report);

} // namespace vdb_shell::growth
