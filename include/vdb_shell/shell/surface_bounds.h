// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdb_shell/mesh/triangle_mesh.h"
#include "vdb_shell/shell/quality.h"
#include "vdb_shell/shell/sides.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace vdb_shell
{

/// What the surface alone says of the tets on it, whatever lies below (docs/theory.md, "What the
/// surface bounds").
struct SurfaceBounds {
    Spread amips;      ///< by triangle: the least AMIPS of any tet that has it as a face
    Spread edge_ratio; ///< by triangle: the least longest edge / shortest edge of such a tet
    /// By edge: of the tets on its two triangles one has no larger smallest dihedral angle. Half
    /// the angle of the solid at the edge, and never above that of the regular tet.
    Spread min_dihedral_radians;
    std::size_t sofa_bad = 0; ///< triangles on which every tet is bad by SOFA's rule
};

/// The least AMIPS of a tet that has this triangle as a face; infinite for one without area.
double least_amips(const openvdb::Vec3d& a, const openvdb::Vec3d& b, const openvdb::Vec3d& c);
/// The least ratio of edges of such a tet, which is the triangle's own.
double least_edge_ratio(const openvdb::Vec3d& a, const openvdb::Vec3d& b, const openvdb::Vec3d& c);

struct EdgeAngle {
    std::array<std::uint32_t, 2> edge; ///< smaller vertex first
    double radians;
};
/// By edge, in ascending order: the angle between its two triangles on the side where the tets are,
/// 0 to 2 pi; for both sides the smaller one. Edges of more or fewer triangles are left out.
std::vector<EdgeAngle> edge_angles(const TriangleMesh& surface, Side side);

SurfaceBounds measure_surface_bounds(const TriangleMesh& surface, Side side);

} // namespace vdb_shell
