// SPDX-License-Identifier: Apache-2.0
#pragma once

// The first valid shell, along lines.

#include "core/stage_progress.h"
#include "growth/grow_state.h"
#include "vdb_shell/growth/grow.h"
#include "vdb_shell/step/directions.h"

#include <vector>

namespace vdb_shell::growth
{

/// The directions made fit for growth, as far as the options ask for it: hidden ones replaced, and
/// if `smooth` all of them smoothed.
Directions prepare_directions(const TriangleMesh& mesh, Directions directions,
                              const GrowOptions& options, bool smooth);

/// Half the ray from each outer point to where it meets the outer surface again, at most half the
/// diagonal: two fronts that move alike would meet there.
std::vector<double> half_rays(const GrowState& s, const Directions& directions);

/// By vertex, a share of the smallest altitude of the triangles around it.
std::vector<double> thin_heights(const GrowState& s);

/// Puts the inner points at these lengths and shortens the pillars of prisms that fail a test until
/// none fails; pins what is lost in the rounding. Leaves a valid shell.
void shrink_until_valid(GrowState& s, const Directions& directions, std::vector<double> length,
                        const StageProgress& progress);

/// A valid start along lines: from long lines that are shrunk until they are valid, or a thin one
/// where that pins fewer vertices or options.top_down is off. `stepped` has the lengths of line
/// stepping.
void start_from_lines(GrowState& s, const Directions& directions,
                      const std::vector<double>& stepped, const GrowOptions& options,
                      const StageProgress& progress);

} // namespace vdb_shell::growth
