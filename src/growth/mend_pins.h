// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/stage_progress.h"
#include "growth/grow_state.h"

#include <vector>

namespace vdb_shell::growth
{

/// Gives the pinned vertices that the surface leaves a pillar one all the same, all at once, and
/// mends what that breaks, by moves and by shortening as far around as it takes (mend_prolonged.h).
/// For what release_last_pins has left: there pillars are changed one by one, each so that all
/// prisms stay valid, which needles do not allow. Of several lengths the one is taken that leaves
/// the fewest pins, and of these the fullest; the shell stays as it is where none leaves fewer.
/// Returns how many fewer there are.
int mend_pins(GrowState& s, const std::vector<double>& visibility, const StageProgress& progress);

} // namespace vdb_shell::growth
