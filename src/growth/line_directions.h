// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdb_shell/growth/schedule.h"
#include "vdb_shell/step/directions.h"

namespace vdb_shell::growth
{

/// Where a direction sees a face of its star from behind, or nearly so, the direction that sees the
/// worst face best takes its place; a vertex whose `visibility` is not positive even then has none.
void mend_directions(const TriangleMesh& mesh, Directions& directions,
                     const InitialSchedule& schedule = {});

/// Bilateral smoothing that never gives up the visibility of a star: weights die out across
/// creases, so that the parts of a machined solid keep their own directions.
void smooth_directions(const TriangleMesh& mesh, Directions& directions,
                       const InitialSchedule& schedule = {});

} // namespace vdb_shell::growth
