// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/stage_progress.h"
#include "growth/grow_state.h"
#include "vdb_shell/step/directions.h"

#include <vector>

namespace vdb_shell::growth
{

/// Puts the inner points at these lengths, of pillars that are nearly valid together, as prolonged
/// ones are, and mends what is not: inner points of prisms that fail a test are moved (untangle.h),
/// and only what that leaves is shortened, by little the first time and by more each time it fails
/// again. Leaves a valid shell; may pin. Gives back what each inner point has lost by that, as six
/// times a volume: about what it can win back.
std::vector<double> mend_prolonged(GrowState& s, const Directions& directions,
                                   const std::vector<double>& length,
                                   const StageProgress& progress);

/// The same where the inner points, rounded to float32, and the pins have been put by the caller.
void mend_placed(GrowState& s, const StageProgress& progress);

} // namespace vdb_shell::growth
