// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/stage_progress.h"
#include "growth/grow_state.h"
#include "vdb_shell/growth/grow.h"
#include "vdb_shell/step/line_step.h"

#include <vector>

namespace vdb_shell::growth
{

struct Improved {
    PrismSplit split;
    std::vector<StopReason> stop; ///< by vertex
};

/// Chooses the diagonals, moves vertices for better tets where options.min_quality asks for that,
/// and finds what holds each vertex back. Adds to the report. `order`: that of the mesh.
Improved improve(GrowState& s, const TriangleMesh& mesh, const MeshOrder& order,
                 const GrowOptions& options, const SplitOptions& split,
                 const StageProgress& progress, GrowReport& report);

} // namespace vdb_shell::growth
