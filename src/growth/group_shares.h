// SPDX-License-Identifier: Apache-2.0
#pragma once

// Which vertices move together, and by how much each.

#include "growth/prolongate.h"
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
/// the same shape, and the weights the hat functions of its triangles: the coordinates of
/// each vertex's point on it.
std::vector<GroupShare> group_shares(const TriangleMesh& coarse,
                                     const std::vector<CoarsePoint>& points);

} // namespace vdb_shell::growth
