// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/stage_progress.h"
#include "growth/grow_state.h"
#include "vdb_shell/step/directions.h"

namespace vdb_shell::growth
{

/// Lengthens along the lines: one vertex at a time, each with a step of its own that doubles after
/// a success and halves after a failure, so that short and long edges need no common scale.
/// Ends after a round that wins less than `least_gain` of the solid, or with the last step when
/// that is negative.
void lengthen_lines(GrowState& s, const Directions& directions, double least_gain,
                    const StageProgress& progress);

} // namespace vdb_shell::growth
