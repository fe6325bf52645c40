// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/stage_progress.h"
#include "growth/grow_state.h"
#include "vdb_shell/growth/grow.h"
#include "vdb_shell/step/directions.h"

namespace vdb_shell::growth
{

/// Shares of the solid.
struct EndOfLines {
    double least_gain;  ///< a round that wins less is the last; negative: the last step is the end
    double enough_fill; ///< no round begins with so much filled
};

/// Lengthens pillars along their lines: one vertex at a time, each with a step of its own that
/// doubles after a success and halves after a failure, so that short and long edges need no common
/// scale.
void lengthen_lines(GrowState& s, const Directions& directions, const EndOfLines& end,
                    const StageProgress& progress);

/// The same unless options.grow_lines is off, or free moves follow that finish the shell sooner:
/// those of a solid that is neither nearly empty nor nearly full.
void lengthen_if_useful(GrowState& s, const Directions& directions, const GrowOptions& options,
                        const StageProgress& progress);

} // namespace vdb_shell::growth
