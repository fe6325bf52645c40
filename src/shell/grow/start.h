// SPDX-License-Identifier: Apache-2.0
#pragma once

// A valid first shell along the directions: what violates is shrunk, what cannot leave the surface
// is pinned.

#include "core/stage_progress.h"
#include "shell/grow/grow_state.h"
#include "vdb_shell/step/directions.h"

namespace vdb_shell::growth
{

inline constexpr double kShrink = 0.65, kShrinkLittle = 0.85;

/// Sets b = a + h d with h as given, lessened until every test passes; may pin. Of the corners of a
/// prism that violates, those from the vertex `first_yielding` on are shrunk first, a few times:
/// where the others' pillars are known to be valid without them, little is lost that way. `shrink`
/// is the factor on a pillar each time.
void settle_start(GrowState& s, const Directions& directions, std::vector<double> h,
                  const StageProgress& progress, std::size_t first_yielding = 0,
                  double shrink = kShrink);

/// A small share of the smallest altitude around each vertex.
std::vector<double> thin_heights(const GrowState& s);
/// Half the length of each inward ray up to the outer surface.
std::vector<double> half_rays(const GrowState& s, const Directions& directions);

} // namespace vdb_shell::growth
