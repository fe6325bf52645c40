// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/stage_progress.h"
#include "growth/grow_state.h"

namespace vdb_shell::growth
{

struct QualityResult {
    std::size_t rounds = 0, flips = 0;
    std::size_t tets_below = 0;     ///< tets under the bound at the end
    std::size_t vertices_below = 0; ///< inner vertices, pinned ones included, with such a tet
};

/// Moves the inner vertices of tets whose mean ratio is under the bound, each so that the shortfall
/// of the tets around it falls and the worst of them does not get worse; all tests of growth hold
/// for every move. Turns diagonals too where `flips` allows. Ends when nothing improves any more,
/// or after a fixed number of rounds.
QualityResult raise_quality(GrowState& s, double bound, bool flips, const StageProgress& progress);

} // namespace vdb_shell::growth
