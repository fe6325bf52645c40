// SPDX-License-Identifier: Apache-2.0
#pragma once

// Which vertices take part in a round, and in a sweep of it.

#include "growth/grow_state.h"

#include <cstdint>
#include <vector>

namespace vdb_shell::growth
{

/// What is remembered of each vertex from one round to the next.
struct ActiveSet {
    /// From the second round on, six times the volume that the vertex won in the last one; before,
    /// what it is predicted to win, or nothing at all.
    std::vector<double> gain;
    std::vector<int> idle_rounds; ///< running, in which it hardly moved
};

/// Where fans are too much work, leaves out the vertices of crowds and those beside them: they keep
/// their lines.
void leave_out_crowds(const GrowState& s, std::vector<std::uint8_t>& inactive);

/// By vertex, whether it is left out of the next round: pinned ones, those of crowds, and those
/// that have not moved for some rounds, but for one round in a few.
std::vector<std::uint8_t> inactive_vertices(const GrowState& s, const ActiveSet& set);

/// Leaves out also those that have no more than `least_gain` (six times a volume) to win, nor has
/// any of their neighbours.
void leave_out_satisfied(const GrowState& s, const ActiveSet& set, double least_gain,
                         std::vector<std::uint8_t>& inactive);

/// Leaves out also those that have won no more than `least_gain` since the round began.
void leave_out_spent(const GrowState& s, double least_gain, std::vector<std::uint8_t>& inactive);

/// Notes which vertices hardly moved in this round.
void count_idle_rounds(const GrowState& s, ActiveSet& set);

/// Notes what the active vertices have won or given way since the round began; one that gives way
/// is not done either.
void measure_gain(const GrowState& s, const std::vector<std::uint8_t>& inactive,
                  std::vector<double>& gain);

} // namespace vdb_shell::growth
