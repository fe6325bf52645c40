// SPDX-License-Identifier: Apache-2.0
#include "write/plane_cut.h"

#include "mesh/topology.h"

#include <algorithm>
#include <utility>

namespace vdb_shell
{
namespace
{

using openvdb::Vec2d;
using openvdb::Vec3s;

/// Where the edge between two points meets the plane, the same whichever end comes first.
Vec2d crossing(const std::vector<Vec3s>& points, std::uint32_t a, std::uint32_t b,
               const CutPlane& plane)
{
    if (a > b)
        std::swap(a, b);
    const openvdb::Vec3d p(points[a]), q(points[b]);
    const double share = (plane.offset - p[plane.normal]) / (q[plane.normal] - p[plane.normal]);
    const openvdb::Vec3d at = p + share * (q - p);
    return {at[plane.right], at[plane.up]};
}

bool is_above(const Vec3s& point, const CutPlane& plane)
{
    return double(point[plane.normal]) >= plane.offset;
}

/// The section of one tet; no corners where it lies on one side.
CutPolygon cut_tet(const TetMesh& mesh, std::size_t t, const CutPlane& plane)
{
    std::array<std::uint32_t, 4> above{}, below{};
    std::size_t aboves = 0, belows = 0;
    for (int corner = 0; corner < 4; ++corner) {
        const std::uint32_t point = mesh.tets[t][corner];
        if (is_above(mesh.points[point], plane))
            above[aboves++] = point;
        else
            below[belows++] = point;
    }
    CutPolygon polygon;
    const auto meet = [&](std::uint32_t a, std::uint32_t b) {
        return crossing(mesh.points, a, b, plane);
    };
    if (aboves == 2) {
        polygon.corners = 4;
        polygon.corner = {meet(below[0], above[0]), meet(below[0], above[1]),
                          meet(below[1], above[1]), meet(below[1], above[0])};
    } else if (aboves == 1 || belows == 1) {
        const std::uint32_t apex = aboves == 1 ? above[0] : below[0];
        const auto& base = aboves == 1 ? below : above;
        for (std::size_t i = 0; i < 3; ++i)
            polygon.corner[i] = meet(apex, base[i]);
    } else {
        polygon.corners = 0;
    }
    return polygon;
}

} // namespace

CutPlane cut_plane(const CrossSectionOptions& options, const Bounds& bounds)
{
    CutPlane plane;
    plane.normal = int(options.axis);
    plane.right = plane.normal == 0 ? 1 : 0;
    plane.up = plane.normal == 2 ? 1 : 2;
    const double low = bounds.low[plane.normal], high = bounds.high[plane.normal];
    plane.offset = low + options.position * (high - low);
    return plane;
}

std::vector<std::uint8_t> prism_tints(const std::vector<openvdb::Vec3I>& triangles)
{
    std::vector<std::vector<std::uint32_t>> neighbours(triangles.size());
    const std::vector<EdgeUse> uses = sorted_edge_uses(triangles);
    for (std::size_t i = 0; i + 1 < uses.size(); ++i)
        if (uses[i].edge == uses[i + 1].edge) {
            neighbours[uses[i].triangle].push_back(uses[i + 1].triangle);
            neighbours[uses[i + 1].triangle].push_back(uses[i].triangle);
        }
    std::vector<std::uint8_t> tints(triangles.size(), kTintCount);
    for (std::uint32_t p = 0; p < triangles.size(); ++p) {
        unsigned taken = 0;
        for (const std::uint32_t neighbour : neighbours[p])
            taken |= 1u << tints[neighbour];
        // A hash picks where to start, or two tints would do most of the surface.
        const std::uint32_t start = (p * 2654435769u) >> 16;
        for (std::uint32_t step = 0; step < kTintCount && tints[p] == kTintCount; ++step) {
            const auto tint = std::uint8_t((start + step) % kTintCount);
            if ((taken & (1u << tint)) == 0)
                tints[p] = tint;
        }
        // More neighbours than tints: only around an edge of many triangles.
        tints[p] = std::min<std::uint8_t>(tints[p], kTintCount - 1);
    }
    return tints;
}

std::vector<CutPolygon> cut_tets(const TetMesh& tets, const std::vector<std::uint8_t>& tints,
                                 const CutPlane& plane)
{
    std::vector<CutPolygon> polygons;
    for (std::size_t t = 0; t < tets.tets.size(); ++t) {
        CutPolygon polygon = cut_tet(tets, t, plane);
        polygon.tint = tints[tets.prism[t]];
        if (polygon.corners > 0)
            polygons.push_back(polygon);
    }
    return polygons;
}

std::vector<CutSegment> cut_surface(const std::vector<Vec3s>& points,
                                    const std::vector<openvdb::Vec3I>& triangles,
                                    const CutPlane& plane)
{
    // Seen along axis y, right (x) and up (z) form a left-handed pair.
    const bool mirrored = plane.normal == 1;
    std::vector<CutSegment> segments;
    for (const openvdb::Vec3I& t : triangles) {
        CutSegment segment;
        int ends = 0;
        for (int side = 0; side < 3; ++side) {
            const std::uint32_t a = t[side], b = t[(side + 1) % 3];
            const bool rises = is_above(points[b], plane);
            if (is_above(points[a], plane) == rises)
                continue;
            (rises ? segment.from : segment.to) = crossing(points, a, b, plane);
            ++ends;
        }
        if (ends != 2)
            continue;
        if (mirrored)
            std::swap(segment.from, segment.to);
        segments.push_back(segment);
    }
    return segments;
}

} // namespace vdb_shell
