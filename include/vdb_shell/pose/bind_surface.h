// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdb_shell/mesh/triangle_mesh.h"

#include <cstdint>
#include <string>
#include <vector>

namespace vdb_shell
{

/// A point tied to a triangle: weights of its corners for the nearest point, and the rest of the
/// way in the triangle's frame (first side, across it, normal), world units.
struct BoundPoint {
    std::uint32_t triangle = 0;
    openvdb::Vec3d weight{0.0}, offset{0.0};
};

/// Ties each point to the nearest triangle of a surface at rest: for a shell whose surface has
/// other triangles than the one that moves, as after a repair, a wrap or a remeshing. Precondition:
/// the surface has triangles.
std::vector<BoundPoint> bind_surface(const std::vector<openvdb::Vec3s>& points,
                                     const TriangleMesh& rest);

/// Where the points go with the surface. Precondition: `posed` has the triangles of the rest
/// surface.
std::vector<openvdb::Vec3s> move_bound(const std::vector<BoundPoint>& bound,
                                       const TriangleMesh& posed);

/// The points in the order in which `wanted` names them. Throws GeometryError, its message opened
/// by `name`, for an id that comes twice or is missing. Precondition: an id for each point.
std::vector<openvdb::Vec3s> in_order_of_ids(const std::vector<openvdb::Vec3s>& points,
                                            const std::vector<std::int64_t>& ids,
                                            const std::vector<std::int64_t>& wanted,
                                            const std::string& name);

} // namespace vdb_shell
