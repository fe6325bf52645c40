// SPDX-License-Identifier: Apache-2.0
// The distance from a point to one triangle, with the sign that says whether the point is inside
// the surface, provided that this triangle is the nearest one. The sign is that of the offset along
// the pseudo-normal of the face, edge or vertex that the nearest point lies on: J. A. Baerentzen
// and H. Aanaes, "Signed Distance Computation Using the Angle Weighted Pseudonormal", 2005, prove
// that this is right for a closed oriented surface that does not cross itself. The normal of the
// nearest triangle alone would be wrong behind sharp edges. A point on the surface counts as
// outside, with distance 0.

#include "field/signed_distance.h"

#include "core/unit_vector.h"
#include "mesh/nearest_on_triangle.h"
#include "vdb_shell/mesh/normals.h"

#include <algorithm>
#include <cmath>

namespace vdb_shell
{

using openvdb::Vec3d;

SignedDistance::SignedDistance(const TriangleMesh& mesh)
    : mesh_(mesh), around_(triangles_around_vertices(mesh.points.size(), mesh.triangles)),
      vertex_normals_(pseudo_normals(mesh))
{
}

std::array<Vec3d, 3> SignedDistance::corners(std::uint32_t triangle) const
{
    const openvdb::Vec3I& t = mesh_.triangles[triangle];
    return {Vec3d(mesh_.points[t[0]]), Vec3d(mesh_.points[t[1]]), Vec3d(mesh_.points[t[2]])};
}

Vec3d SignedDistance::unit_normal(std::uint32_t triangle) const
{
    const std::array<Vec3d, 3> c = corners(triangle);
    return unit_vector((c[1] - c[0]).cross(c[2] - c[0]));
}

Vec3d SignedDistance::edge_normal(std::uint32_t triangle, int side) const
{
    // Both faces count alike whatever their area, because the angle of a face at a point of its
    // edge is half a turn. Only the sign of a product with the sum is used, so it is not divided by
    // two.
    Vec3d normal = unit_normal(triangle);
    const std::uint32_t from = mesh_.triangles[triangle][side];
    const std::uint32_t to = mesh_.triangles[triangle][(side + 1) % 3];
    for (const std::uint32_t other : around_.around(from)) {
        const openvdb::Vec3I& t = mesh_.triangles[other];
        if (other != triangle && (t[0] == to || t[1] == to || t[2] == to))
            normal += unit_normal(other);
    }
    return normal;
}

double SignedDistance::at(const Vec3d& point, std::uint32_t triangle) const
{
    const std::array<Vec3d, 3> c = corners(triangle);
    const NearestOnTriangle nearest = nearest_on_triangle(c, point);
    const Vec3d offset = point - nearest.point;
    Vec3d normal(0.0);
    switch (nearest.on) {
    case NearestOnTriangle::On::face:
        normal = (c[1] - c[0]).cross(c[2] - c[0]);
        break;
    case NearestOnTriangle::On::side:
        normal = edge_normal(triangle, nearest.k);
        break;
    case NearestOnTriangle::On::corner:
        normal = vertex_normals_[mesh_.triangles[triangle][nearest.k]];
        break;
    }
    return offset.dot(normal) < 0 ? -offset.length() : offset.length();
}

} // namespace vdb_shell
