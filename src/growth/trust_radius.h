// SPDX-License-Identifier: Apache-2.0
#pragma once

// How far each vertex may go in one round.

#include "growth/grow_state.h"

#include <cstdint>
#include <vector>

namespace vdb_shell::growth
{

/// First radii, the short ones of TrustRadiusSchedule or longer ones.
void set_first_radii(GrowState& s, bool short_ones);

/// Radii for the next round, of the vertices that were active in this one: hardly more than a
/// vertex went.
void adapt_radii(GrowState& s, const std::vector<std::uint8_t>& inactive);

/// The mean length of the edges at a vertex, its surface having these points; 0 where it has none.
double mean_edge(const Connectivity& mesh, const std::vector<Vec3d>& points, int v);

/// x, or the point towards it that rounding cannot take out of the trust region of v.
Vec3d within_trust_radius(const GrowState& s, int v, const Vec3d& x);

} // namespace vdb_shell::growth
