// SPDX-License-Identifier: Apache-2.0

// Takes points near a surface at rest, and the surface in a pose. Leaves the points where the
// surface carries them, each with the nearest triangle as a rigid frame.

#include "vdb_shell/pose/bind_surface.h"

#include "vdb_shell/core/error.h"

#include "core/parallel.h"
#include "mesh/nearest_on_triangle.h"
#include "mesh/triangle_corners.h"
#include "obstacles/nearest_core.h"

#include <array>
#include <cassert>
#include <unordered_map>

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
    frame.corner = triangle_corners(mesh, triangle);
    const Vec3d side = frame.corner[1] - frame.corner[0];
    Vec3d along = side, normal = side.cross(frame.corner[2] - frame.corner[0]);
    along.normalize(0.0);
    normal.normalize(0.0);
    frame.axis = {along, normal.cross(along), normal};
    return frame;
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
        BoundPoint& made = bound[i];
        made.triangle = nearest.nearest(p).triangle;
        const Frame frame = frame_of(rest, made.triangle);
        const std::array<double, 3> weight = nearest_weights(frame.corner, p);
        made.weight = {weight[0], weight[1], weight[2]};
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

std::vector<openvdb::Vec3s> in_order_of_ids(const std::vector<openvdb::Vec3s>& points,
                                            const std::vector<std::int64_t>& ids,
                                            const std::vector<std::int64_t>& wanted,
                                            const std::string& name)
{
    assert(points.size() == ids.size());
    std::unordered_map<std::int64_t, std::size_t> place;
    for (std::size_t i = 0; i < ids.size(); ++i)
        if (!place.emplace(ids[i], i).second)
            throw GeometryError(name + ": the points " + std::to_string(place[ids[i]]) + " and " +
                                std::to_string(i) + " have the same id " + std::to_string(ids[i]));
    std::vector<openvdb::Vec3s> ordered;
    ordered.reserve(wanted.size());
    for (const std::int64_t id : wanted) {
        const auto found = place.find(id);
        if (found == place.end())
            throw GeometryError(name + ": no point has the id " + std::to_string(id));
        ordered.push_back(points[found->second]);
    }
    return ordered;
}

} // namespace vdb_shell
