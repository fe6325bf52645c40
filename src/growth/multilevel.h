// SPDX-License-Identifier: Apache-2.0
#pragma once

// Growth on coarser surfaces before the given one.

#include "core/stage_progress.h"
#include "growth/grow_state.h"
#include "mesh/curve_order.h"
#include "vdb_shell/growth/grow.h"

#include <vector>

namespace vdb_shell::growth
{

/// Grows on each of the levels, from the last, the coarsest, which starts from lines, to the first,
/// and puts the state of the mesh onto what comes of it: a valid shell, nearly done. `order`: that
/// of the mesh, of which the levels name vertices as they stood before. `stepped` has the lengths
/// of line stepping, of use at the coarsest level's vertices alone. Gives back what each vertex has
/// lost in mending, RelaxOptions::predicted_gain, and counts the pins that it released on the mesh
/// itself. Precondition: there are levels.
std::vector<double> start_from_levels(GrowState& s, const TriangleMesh& mesh,
                                      const Directions& lines, const std::vector<double>& stepped,
                                      const std::vector<Coarsened>& levels, const MeshOrder& order,
                                      const GrowOptions& options, const StageProgress& progress,
                                      GrowReport& report);

} // namespace vdb_shell::growth
