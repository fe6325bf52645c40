// SPDX-License-Identifier: Apache-2.0
#pragma once

// Broad phase: which triangles an inner triangle may meet until the lists are made again.

#include "shell/grow/grow_state.h"

namespace vdb_shell::growth
{

/// Makes boxes and candidate lists for the present positions, which become the homes. Left out are
/// pairs that cannot touch while every vertex keeps to its reach.
void rebuild_candidates(GrowState& s);
/// The same for the marked faces only, on the tree of the last rebuild_candidates.
void update_candidates(GrowState& s, const std::vector<std::uint8_t>& faces);

} // namespace vdb_shell::growth
