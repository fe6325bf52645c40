// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdb_shell/mesh/check_mesh.h"

#include <cstdint>
#include <vector>

namespace vdb_shell
{

/// A walk along boundary edges, on any surface however bad: the points in order, the first not
/// repeated at the end. `closed` is off for a walk that ends where edges of three or more triangles
/// leave an odd number of boundary edges at a point.
struct BoundaryWalk {
    std::vector<std::uint32_t> points;
    bool closed = true;
};

/// Each boundary edge in exactly one walk; by the smallest edge. Points where several boundaries
/// meet part the walks: a closed walk passes no point twice.
std::vector<BoundaryWalk> boundary_walks(const std::vector<Edge>& boundary_edges);

} // namespace vdb_shell
