// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "growth/grow_state.h"
#include "pose/centre_points.h"
#include "pose/skin_side.h"

namespace vdb_shell
{

/// Pillars that growth gave up: pinned, although their cap allows them a length.
std::size_t lost_pillars(const growth::GrowState& s);

/// By point: the ends of lost pillars, and of those beside them.
std::vector<std::uint8_t> around_lost(const RestShell::Parts& parts, const SkinSide& side,
                                      const growth::GrowState& s);

/// Lost pillars begin again from places where the tets around them are positive, and are mended by
/// growth. Leaves the state with the fewest of them. `carried`: where points are that are lost.
void restart_lost(const RestShell::Parts& parts, const SkinSide& side, const PoseState& carried,
                  const InvertedTets& inverted, const PoseOptions& options, growth::GrowState& s,
                  const StageProgress& progress);

} // namespace vdb_shell
