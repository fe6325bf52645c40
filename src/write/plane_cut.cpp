// SPDX-License-Identifier: Apache-2.0

// Takes tets or triangles and a plane across an axis; gives the sections, in double. The idea that
// avoids all special cases: a point on the plane counts as above it, as if the plane were moved by
// less than any number. Then a tet is cut in three edges, in four, or not at all, and a triangle in
// two or in none. Points of a section depend on the edge alone, so sections of neighbours share
// their corners bit for bit; the drawing relies on that.

#include "write/plane_cut.h"

#include "vdb_shell/shell/core_tets.h"

#include "mesh/topology.h"

#include <algorithm>
#include <utility>

namespace vdb_shell
{
namespace
{

using openvdb::Vec2d;
using openvdb::Vec3s;

/// Where the edge between two points meets the plane, the same whichever end comes first. The ends
/// are ordered by index, as rounding would differ if two tets went along the edge in opposite
/// directions. The denominator is not 0: the edge has one end on each side of the plane, so the
/// coordinates are different floats, and their difference in double is not 0 either.
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

} // namespace

CutPlane cut_plane(const CrossSectionOptions& options, const Bounds& bounds)
{
    CutPlane plane;
    plane.normal = int(options.axis);
    // The section across x shows y and z, across y it shows x and z, across z it shows x and y; the
    // first of each pair points to the right.
    plane.right = plane.normal == 0 ? 1 : 0;
    plane.up = plane.normal == 2 ? 1 : 2;
    const double low = bounds.low[plane.normal], high = bounds.high[plane.normal];
    plane.offset = low + options.position * (high - low);
    return plane;
}

std::vector<std::uint8_t> prism_tints(const std::vector<openvdb::Vec3I>& triangles)
{
    // Uses of the same edge stand beside each other after sorting. A triangle of a manifold surface
    // has three neighbours, so six tints always leave one free; more than that are there only to
    // make the picture less regular. Tints follow from the order of the triangles and from nothing
    // random.
    std::vector<std::vector<std::uint32_t>> neighbours(triangles.size());
    const EdgeUses uses = sorted_edge_uses(triangles);
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
        // A hash picks where to start, or two tints would cover most of the surface. It is
        // Fibonacci hashing (Knuth, The Art of Computer Programming, volume 3, "Hashing"): the
        // factor is 2^32 over the golden ratio.
        const std::uint32_t start = (p * 2654435769u) >> 16;
        for (std::uint32_t step = 0; step < kTintCount && tints[p] == kTintCount; ++step) {
            const auto tint = std::uint8_t((start + step) % kTintCount);
            if ((taken & (1u << tint)) == 0)
                tints[p] = tint;
        }
        // No tint is left where a triangle has six neighbours or more, which happens only around
        // edges of more than two triangles. Then two neighbours may look the same, and nothing
        // worse happens.
        tints[p] = std::min<std::uint8_t>(tints[p], kTintCount - 1);
    }
    return tints;
}

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
    // Two against two: consecutive corners of this list lie on a common face of the tet, so they go
    // round the section once and the polygon does not cross itself.
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

std::vector<CutPolygon> cut_tets(const TetMesh& tets, const std::vector<std::uint8_t>& tints,
                                 const CutPlane& plane)
{
    std::vector<CutPolygon> polygons;
    for (std::size_t t = 0; t < tets.tets.size(); ++t) {
        CutPolygon polygon = cut_tet(tets, t, plane);
        polygon.tint = tets.prism[t] == kCorePrism ? kCoreTint : tints[tets.prism[t]];
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
            // The direction follows from the triangle's own orientation, counter-clockwise seen
            // from outside: the segment begins where its side rises through the plane.
            const bool rises = is_above(points[b], plane);
            if (is_above(points[a], plane) == rises)
                continue;
            (rises ? segment.from : segment.to) = crossing(points, a, b, plane);
            ++ends;
        }
        // A triangle with all corners on one side; an odd number of ends cannot occur, because
        // going round a triangle changes sides an even number of times.
        if (ends != 2)
            continue;
        if (mirrored)
            std::swap(segment.from, segment.to);
        segments.push_back(segment);
    }
    return segments;
}

double section_area(const std::vector<Vec3s>& points, const std::vector<openvdb::Vec3I>& triangles,
                    const CutPlane& plane)
{
    const std::vector<CutSegment> segments = cut_surface(points, triangles, plane);
    double twice = 0;
    for (const CutSegment& segment : segments) {
        // From a corner of the section: about the origin, digits would be lost far from it.
        const Vec2d from = segment.from - segments[0].from, to = segment.to - segments[0].from;
        // Clockwise about the solid.
        twice += from.y() * to.x() - from.x() * to.y();
    }
    return twice / 2;
}

CrossSectionOptions with_axis(CrossSectionOptions options, const std::vector<Vec3s>& points,
                              const std::vector<openvdb::Vec3I>& triangles)
{
    if (options.axis != Axis::widest)
        return options;
    // Areas that are equal but for rounding are equal: a cube is cut across z.
    constexpr double kMore = 1 + 1e-6;
    const Bounds box = bounds_of(points);
    const auto area_across = [&](Axis axis) {
        return section_area(points, triangles, cut_plane({axis, options.position}, box));
    };
    options.axis = Axis::z;
    double most = area_across(Axis::z);
    for (const Axis axis : {Axis::y, Axis::x})
        if (const double area = area_across(axis); area > kMore * most) {
            options.axis = axis;
            most = area;
        }
    return options;
}

} // namespace vdb_shell
