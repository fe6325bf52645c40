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

/// What becomes of pillars along lines that are not valid together.
enum class LineStart {
    shrunk, ///< long ones; those of prisms that fail are shortened until none fails, so that rounds
            ///< begin with room on all sides
    mended, ///< long ones, mended as prolonged ones are (mend_prolonged.h): inner points leave
            ///< their lines, which beside needles is the only way not to lose most of a pillar
    planar, ///< the same along lines that make the quads of prisms planar (planar_quads.h), which
            ///< beside needles leaves little to mend
    thin,   ///< short ones
};

/// Whether pillars do not end on the lines that they were begun along.
inline bool leaves_lines(LineStart start)
{
    return start == LineStart::mended || start == LineStart::planar;
}

/// A valid start along lines; in place of a shrunk one a thin one where that pins fewer vertices.
/// `stepped` has the lengths of line stepping. Mended and planar starts are made under the test
/// that the shell is to pass in the end, the others under the twelve-tet test.
void start_from_lines(GrowState& s, const Directions& directions,
                      const std::vector<double>& stepped, LineStart start,
                      const GrowOptions& options, const StageProgress& progress);

} // namespace vdb_shell::growth
