// SPDX-License-Identifier: Apache-2.0

// Takes points near a surface at rest, and the surface in a pose. Leaves the points where the
// surface carries them, each with the nearest triangle as a rigid frame.

#include "vdb_shell/pose/bind_surface.h"

#include "core/parallel.h"
#include "obstacles/nearest_core.h"

#include <algorithm>
#include <array>
#include <cassert>

namespace vdb_shell
{
namespace
{

using openvdb::Vec3d;

struct Frame {
    std::array<Vec3d, 3> corner, axis;
};

/// A triangle without area has a frame of less than three axes; what lies along the others is lost.
Frame frame_of(const TriangleMesh& mesh, std::uint32_t triangle)
{
    Frame frame;
    for (std::size_t k = 0; k < 3; ++k)
        frame.corner[k] = Vec3d(mesh.points[mesh.triangles[triangle][int(k)]]);
    const Vec3d side = frame.corner[1] - frame.corner[0];
    Vec3d along = side, normal = side.cross(frame.corner[2] - frame.corner[0]);
    along.normalize(0.0);
    normal.normalize(0.0);
    frame.axis = {along, normal.cross(along), normal};
    return frame;
}

/// Barycentric coordinates of a point in the triangle's plane, by least squares.
Vec3d weights_of(const Frame& frame, const Vec3d& point)
{
    const Vec3d u = frame.corner[1] - frame.corner[0], v = frame.corner[2] - frame.corner[0],
                w = point - frame.corner[0];
    const double uu = u.lengthSqr(), vv = v.lengthSqr(), uv = u.dot(v);
    const double area = uu * vv - uv * uv;
    if (!(area > 0))
        return {1, 0, 0};
    const double second = (vv * u.dot(w) - uv * v.dot(w)) / area;
    const double third = (uu * v.dot(w) - uv * u.dot(w)) / area;
    return {1 - second - third, second, third};
}

Vec3d at(const Frame& frame, const Vec3d& weight)
{
    return weight[0] * frame.corner[0] + weight[1] * frame.corner[1] + weight[2] * frame.corner[2];
}

} // namespace

std::vector<BoundPoint> bind_surface(const std::vector<openvdb::Vec3s>& points,
                                     const TriangleMesh& rest)
{
    const NearestOnMesh nearest(rest);
    std::vector<BoundPoint> bound(points.size());
    for_each_index(points.size(), [&](std::size_t i) {
        const Vec3d p(points[i]);
        const NearestPoint found = nearest.nearest(p);
        const Frame frame = frame_of(rest, found.triangle);
        BoundPoint& made = bound[i];
        made.triangle = found.triangle;
        made.weight = weights_of(frame, found.point);
        const Vec3d left = p - at(frame, made.weight);
        for (int k = 0; k < 3; ++k)
            made.offset[k] = left.dot(frame.axis[std::size_t(k)]);
    });
    return bound;
}

std::vector<openvdb::Vec3s> move_bound(const std::vector<BoundPoint>& bound,
                                       const TriangleMesh& posed)
{
    std::vector<openvdb::Vec3s> points(bound.size());
    for_each_index(bound.size(), [&](std::size_t i) {
        const BoundPoint& b = bound[i];
        assert(b.triangle < posed.triangles.size());
        const Frame frame = frame_of(posed, b.triangle);
        Vec3d p = at(frame, b.weight);
        for (int k = 0; k < 3; ++k)
            p += b.offset[k] * frame.axis[std::size_t(k)];
        points[i] = openvdb::Vec3s(p);
    });
    return points;
}

} // namespace vdb_shell
