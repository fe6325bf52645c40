// SPDX-License-Identifier: Apache-2.0
#include "field/signed_distance.h"

#include "vdb_shell/step/directions.h"

#include <algorithm>
#include <cmath>

namespace vdb_shell
{
namespace
{

using openvdb::Vec3d;

/// The nearest point of a triangle and what of it that lies on: the face, side k (from corner k) or
/// corner k.
struct Nearest {
    enum class On { face, side, corner };
    Vec3d point{0.0};
    On on = On::face;
    int k = 0;
};

Nearest nearest_on_side(const std::array<Vec3d, 3>& c, int k, const Vec3d& p)
{
    const auto i = static_cast<std::size_t>(k), j = (i + 1) % 3;
    const Vec3d e = c[j] - c[i];
    const double squared = e.lengthSqr(), along = squared > 0 ? (p - c[i]).dot(e) / squared : 0.0;
    if (along <= 0)
        return {c[i], Nearest::On::corner, k};
    if (along >= 1)
        return {c[j], Nearest::On::corner, static_cast<int>(j)};
    return {c[i] + along * e, Nearest::On::side, k};
}

Nearest nearest_on(const std::array<Vec3d, 3>& c, const Vec3d& p)
{
    const Vec3d n = (c[1] - c[0]).cross(c[2] - c[0]);
    const double squared = n.lengthSqr();
    bool beyond_any = !(squared > 0);
    for (std::size_t k = 0; k < 3; ++k)
        beyond_any = beyond_any || (c[(k + 1) % 3] - c[k]).cross(n).dot(p - c[k]) > 0;
    if (!beyond_any)
        return {p - (p - c[0]).dot(n) / squared * n, Nearest::On::face, 0};
    Nearest best = nearest_on_side(c, 0, p);
    for (int k = 1; k < 3; ++k) {
        const Nearest other = nearest_on_side(c, k, p);
        if ((other.point - p).lengthSqr() < (best.point - p).lengthSqr())
            best = other;
    }
    return best;
}

} // namespace

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
    Vec3d n = (c[1] - c[0]).cross(c[2] - c[0]);
    n.normalize();
    return n;
}

Vec3d SignedDistance::edge_normal(std::uint32_t triangle, int side) const
{
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
    const Nearest nearest = nearest_on(c, point);
    const Vec3d offset = point - nearest.point;
    Vec3d normal;
    switch (nearest.on) {
    case Nearest::On::face:
        normal = (c[1] - c[0]).cross(c[2] - c[0]);
        break;
    case Nearest::On::side:
        normal = edge_normal(triangle, nearest.k);
        break;
    case Nearest::On::corner:
        normal = vertex_normals_[mesh_.triangles[triangle][nearest.k]];
        break;
    }
    return offset.dot(normal) < 0 ? -offset.length() : offset.length();
}

double SignedDistance::unsigned_at(const Vec3d& point, std::uint32_t triangle) const
{
    return (point - nearest_on(corners(triangle), point).point).length();
}

} // namespace vdb_shell
