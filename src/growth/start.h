// SPDX-License-Identifier: Apache-2.0
#pragma once

// A valid first shell along the directions: what violates is shrunk, what cannot leave the surface
// is pinned.

#include "core/stage_progress.h"
#include "growth/grow_state.h"
#include "vdb_shell/step/directions.h"

namespace vdb_shell::growth
{

/// Sets b = a + h d with h as given, lessened until every test passes; may pin.
void settle_start(GrowState& s, const Directions& directions, std::vector<double> h,
                  const StageProgress& progress);

/// The same for pillars that are nearly valid together, as those carried over from the shell of a
/// coarser surface are: inner points of prisms that violate are moved (untangle.h), and only what
/// that leaves is shortened, by little the first time and by more each time it comes up again.
/// Gives back what each inner point has lost by that, as volume6: about what it can win back.
std::vector<double> settle_carried(GrowState& s, const Directions& directions,
                                   const std::vector<double>& h, const StageProgress& progress);

/// A small share of the smallest altitude around each vertex.
std::vector<double> thin_heights(const GrowState& s);
/// Half the length of each inward ray up to the outer surface.
std::vector<double> half_rays(const GrowState& s, const Directions& directions);

} // namespace vdb_shell::growth
