// SPDX-License-Identifier: Apache-2.0

// Normals at vertices, weighted by the angles of the triangles (Baerentzen and Aanaes, "Signed
// Distance Computation Using the Angle Weighted Pseudonormal", 2005). With these weights the normal
// does not depend on how a flat face is cut into triangles, and its scalar product with the way
// from the nearest vertex to a point has the right sign. It does not guarantee that the vertex's
// triangles are all seen from it: visibility_of() says whether they are. Each vertex sums over its
// triangles in ascending order, so threads change no bit.

#include "vdb_shell/mesh/normals.h"

#include "core/parallel.h"
#include "core/raw_vector.h"
#include "mesh/topology.h"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace vdb_shell
{

using openvdb::Vec3d;

namespace
{

Vec3d corner(const TriangleMesh& mesh, std::uint32_t triangle, int i)
{
    return Vec3d(mesh.points[mesh.triangles[triangle][i]]);
}

/// Unit normals, zero for triangles without area. Edges of float32 points are exact enough in
/// double that their cross product vanishes only where the area does.
RawVector<Vec3d> triangle_normals(const TriangleMesh& mesh)
{
    RawVector<Vec3d> normals(mesh.triangles.size());
    for_each_index(normals.size(), [&](std::size_t i) {
        const auto t = static_cast<std::uint32_t>(i);
        const Vec3d a = corner(mesh, t, 0);
        const Vec3d cross = (corner(mesh, t, 1) - a).cross(corner(mesh, t, 2) - a);
        const double length = cross.length();
        normals[i] = length > 0 ? cross / length : Vec3d(0.0);
    });
    return normals;
}

double angle_at(const TriangleMesh& mesh, std::uint32_t triangle, std::size_t vertex)
{
    int i = 0;
    while (mesh.triangles[triangle][i] != vertex)
        ++i;
    const Vec3d p = corner(mesh, triangle, i);
    const Vec3d u = corner(mesh, triangle, (i + 1) % 3) - p;
    const Vec3d v = corner(mesh, triangle, (i + 2) % 3) - p;
    // Not the arc cosine, which loses half of the digits near 0 and near a straight angle.
    return std::atan2(u.cross(v).length(), u.dot(v));
}

} // namespace

Vec3d unit_or_zero(const Vec3d& v, double scale)
{
    // Below this, a sum of unit vectors (or a gradient of slope one) is rounding, not a direction.
    constexpr double kNoDirection = 1e-9;
    const double length = v.length();
    return length > kNoDirection * scale ? v / length : Vec3d(0.0);
}

std::vector<Vec3d> pseudo_normals(const TriangleMesh& mesh)
{
    const VertexTriangles vertex_triangles =
        triangles_around_vertices(mesh.points.size(), mesh.triangles);
    const RawVector<Vec3d> normals = triangle_normals(mesh);
    std::vector<Vec3d> result(mesh.points.size());
    for_each_index(result.size(), [&](std::size_t v) {
        Vec3d sum(0.0);
        double angles = 0;
        for (const std::uint32_t t : vertex_triangles.around(v)) {
            const double angle = angle_at(mesh, t, v);
            sum += angle * normals[t];
            angles += angle;
        }
        result[v] = unit_or_zero(sum, angles);
    });
    return result;
}

std::vector<double> visibility_of(const TriangleMesh& mesh, const std::vector<Vec3d>& outward)
{
    assert(outward.size() == mesh.points.size());
    const VertexTriangles vertex_triangles =
        triangles_around_vertices(mesh.points.size(), mesh.triangles);
    const RawVector<Vec3d> normals = triangle_normals(mesh);
    std::vector<double> result(outward.size());
    for_each_index(result.size(), [&](std::size_t v) {
        // No direction has the visibility 0, which the vector holds already.
        if (outward[v].lengthSqr() == 0)
            return;
        double least = 1;
        for (const std::uint32_t t : vertex_triangles.around(v))
            // A triangle without area cannot be seen from any side and would make the vertex blind.
            if (normals[t].lengthSqr() > 0)
                least = std::min(least, outward[v].dot(normals[t]));
        result[v] = least;
    });
    return result;
}

} // namespace vdb_shell
