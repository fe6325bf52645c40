// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdb_shell/mesh/check_mesh.h"
#include "vdb_shell/mesh/triangle_mesh.h"

#include <cstddef>
#include <cstdint>

namespace vdb_shell
{

struct FanSplit {
    TriangleMesh mesh;
    Defect<std::uint32_t> vertices; ///< that got copies
    std::size_t copies = 0;
};

/// Gives each fan of triangles at a vertex a vertex of its own: triangles that hang together by
/// edges at the vertex. The fan of the smallest triangle keeps the vertex; the others get copies at
/// the same place, behind all points, in the order of vertices and fans. Triangles keep their
/// order; a surface without such vertices is not changed. Edges of three or more triangles stay
/// what they are. The fans then touch in a point: a self-intersection by check_mesh.
/// Precondition: corners index the points.
FanSplit split_fans(TriangleMesh mesh);

} // namespace vdb_shell
