// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/stage_progress.h"
#include "growth/grow_state.h"

#include <cstddef>
#include <vector>

namespace vdb_shell::growth
{

/// Puts inner points back to where they were before mending, or part of the way, where the exact
/// tests allow it: one after another, those that have lost most volume first, and none that has
/// lost less than its share of what is empty (MendSchedule). The shell stays valid. Returns how
/// many points were moved; the inner tree is left with the boxes of now.
std::size_t lengthen_again(GrowState& s, const std::vector<Vec3d>& before,
                           const StageProgress& progress);

/// To first order, six times the volume that each inner point's move from where it was has taken
/// from the shell.
std::vector<double> volume6_lost(const GrowState& s, const std::vector<Vec3d>& before);

} // namespace vdb_shell::growth
