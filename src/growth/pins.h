// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/stage_progress.h"
#include "growth/grow_state.h"

#include <vector>

namespace vdb_shell::growth
{

/// What may be done to the pillars around a pinned vertex that they leave no pillar: nothing; they
/// may be shortened; they may be turned as well, where that is needed.
enum class PillarsBesidePin { kept, shortened, turned };

/// Gives pinned vertices a pillar again where the exact tests allow one: a start that is thin may
/// have been lost in the rounding of the coordinates, or neighbours in the way have moved. In the
/// order of the indices, each vertex tried a bounded number of times. Returns how many were
/// released. Precondition: the inner tree has been built; its boxes are left as this needs them.
int release_pins(GrowState& s, const std::vector<double>& visibility, PillarsBesidePin beside);

/// The same when there is nothing left to wait for: pillars beside a pin are also taken away, until
/// it has one, and given back shorter. Under the three-tet test, where the prisms around leave no
/// way, their pillars are shortened first until they pass the twelve-tet test.
int release_last_pins(GrowState& s, const std::vector<double>& visibility,
                      const StageProgress& progress);

/// The pinned vertices that a pillar may be found for, ascending.
std::vector<int> pins_to_release(const GrowState& s, const std::vector<double>& visibility);

/// The longest pillar that is tried for one: about what it would have had without the pin.
double longest_release(const GrowState& s, int v);

} // namespace vdb_shell::growth
