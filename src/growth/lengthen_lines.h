// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/stage_progress.h"
#include "growth/grow_state.h"
#include "vdb_shell/growth/grow.h"
#include "vdb_shell/step/directions.h"

namespace vdb_shell::growth
{

/// Lengthens pillars along their lines: one vertex at a time, each with a step of its own that
/// doubles after a success and halves after a failure, so that short and long edges need no common
/// scale. Ends after a round that wins less than `least_gain`, a share of the solid, or with the
/// last step when that is negative.
void lengthen_lines(GrowState& s, const Directions& directions, double least_gain,
                    const StageProgress& progress);

/// The same unless options.grow_lines is off, or free moves follow that finish the shell sooner:
/// those of a solid that is neither nearly empty nor nearly full.
void lengthen_if_useful(GrowState& s, const Directions& directions, const GrowOptions& options,
                        const StageProgress& progress);

} // namespace vdb_shell::growth
