// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/stage_progress.h"
#include "growth/group_shares.h"
#include "growth/grow_state.h"

#include <vector>

namespace vdb_shell::growth
{

/// Moves the inner points of many vertices at once, group after group, each in the direction in
/// which the volume inside the inner surface falls, as far as a barrier on the tets around the
/// group and planes between it and what it would meet allow. A void as wide as many triangles is
/// filled in few such moves, while a vertex by itself gets no further than part of an edge.
/// Every move is tested exactly before it is kept, and wins volume. How many were kept.
/// Deterministic for any number of threads.
///
/// Source: corrections from a subspace, one after the other (Xu 1992, "Iterative methods by space
/// decomposition and subspace correction"), with the barrier's Newton step in each.
std::size_t move_groups(GrowState& s, const std::vector<GroupShare>& shares,
                        const StageProgress& progress);

} // namespace vdb_shell::growth
