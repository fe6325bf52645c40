// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/stage_progress.h"
#include "growth/grow_state.h"
#include "vdb_shell/mesh/triangle_mesh.h"

#include <vector>

namespace vdb_shell::growth
{

/// A vertex's part in the move of a group.
struct GroupShare {
    int group, vertex;
    double weight; ///< of the group's move, from 0 to 1
};

/// By group, and in a group by vertex. The groups are the vertices of a coarser surface of about
/// the same shape, and the weights the hat functions of its triangles: the coordinates of a
/// vertex's nearest point on it.
std::vector<GroupShare> group_shares(const TriangleMesh& mesh, const TriangleMesh& coarse,
                                     const MultilevelSchedule& schedule);

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
