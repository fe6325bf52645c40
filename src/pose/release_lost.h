// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/stage_progress.h"
#include "growth/grow_state.h"

namespace vdb_shell
{

/// Gives pillars to vertices that are pinned although their cap allows one. Where a carried
/// direction does not see the triangles of a folded skin, a pillar is lost however short it gets:
/// it and those around it begin again, short, along directions that do. What is lost after some
/// attempts stays pinned. Precondition: a valid state on `mesh`, as growth/mend_prolonged.h leaves.
void release_lost(growth::GrowState& s, const TriangleMesh& mesh, const StageProgress& progress);

} // namespace vdb_shell
