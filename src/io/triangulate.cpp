// SPDX-License-Identifier: Apache-2.0

// Cuts a polygon into triangles. A convex polygon becomes a fan, any other is cut ear by ear
// (Meisters, "Polygons Have Ears", 1975: each simple polygon of more than three corners has two),
// seen along the largest axis of its normal. Signs are computed in doubles and rounded, which is
// enough: whatever they say, there are n - 2 triangles of three different corners each, and every
// side of the polygon is in exactly one of them, so neighbours fit together. A wrong sign only
// decides which of these surfaces the polygon becomes. Cutting takes O(n^3) at worst, hence the
// limit.

#include "io/triangulate.h"

#include "io/file_scan.h"

#include <cmath>
#include <cstddef>

namespace vdb_shell
{
namespace
{

using Vec2d = openvdb::Vec2d;

/// Twice the vector area, which is normal to a planar polygon also where corners are reflex
/// (Newell's normal). It is summed over the triangles of a fan about the first corner, so that the
/// distance from the origin loses no digits.
openvdb::Vec3d newell_normal(const std::vector<openvdb::Vec3s>& points, const Polygon& polygon)
{
    openvdb::Vec3d normal(0.0);
    const openvdb::Vec3d origin(points[polygon[0]]);
    for (std::size_t k = 1; k + 1 < polygon.size(); ++k)
        normal += (openvdb::Vec3d(points[polygon[k]]) - origin)
                      .cross(openvdb::Vec3d(points[polygon[k + 1]]) - origin);
    return normal;
}

/// The corners with the normal's largest axis left out, in the order of axes in which the polygon
/// runs anticlockwise. For a planar polygon this is an affine map, which turns no triangle over.
std::vector<Vec2d> flattened(const std::vector<openvdb::Vec3s>& points, const Polygon& polygon)
{
    const openvdb::Vec3d normal = newell_normal(points, polygon);
    const auto axis = static_cast<int>(openvdb::math::MaxIndex(openvdb::math::Abs(normal)));
    int u = (axis + 1) % 3, v = (axis + 2) % 3;
    if (normal[axis] < 0)
        std::swap(u, v);
    std::vector<Vec2d> flat;
    for (const std::uint32_t corner : polygon)
        flat.emplace_back(points[corner][u], points[corner][v]);
    return flat;
}

double doubled_area(const Vec2d& a, const Vec2d& b, const Vec2d& c)
{
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}

/// Left turns at all corners are not enough, since a polygon can wind twice. Seen from its first
/// corner its other corners must be in order too.
bool is_convex(const std::vector<Vec2d>& flat)
{
    const std::size_t n = flat.size();
    for (std::size_t k = 1; k + 1 < n; ++k)
        // These are the triangles of the fan itself, so none of them may be flat either.
        if (doubled_area(flat[0], flat[k], flat[k + 1]) <= 0)
            return false;
    for (std::size_t k = 0; k < n; ++k)
        if (doubled_area(flat[k], flat[(k + 1) % n], flat[(k + 2) % n]) < 0)
            return false;
    return true;
}

/// Whether the corner at `k` of `left` can be cut off.
bool is_ear(const std::vector<Vec2d>& flat, const Polygon& polygon,
            const std::vector<std::size_t>& left, std::size_t k)
{
    const std::size_t n = left.size();
    const std::size_t before = left[(k + n - 1) % n], at = left[k], after = left[(k + 1) % n];
    const Vec2d &a = flat[before], &b = flat[at], &c = flat[after];
    if (polygon[before] == polygon[after] || doubled_area(a, b, c) <= 0)
        return false;
    for (const std::size_t other : left) {
        // A corner that comes twice does not stand in the way of itself.
        const std::uint32_t corner = polygon[other];
        if (corner == polygon[before] || corner == polygon[at] || corner == polygon[after])
            continue;
        const Vec2d& p = flat[other];
        // Corners on the ear's boundary stand in the way too: if it were cut off past them, they
        // would be left on one line, where there is no ear.
        if (doubled_area(a, b, p) >= 0 && doubled_area(b, c, p) >= 0 && doubled_area(c, a, p) >= 0)
            return false;
    }
    return true;
}

/// False when no ear can be found, with nothing appended.
bool cut_ears(const std::vector<Vec2d>& flat, const Polygon& polygon,
              std::vector<openvdb::Vec3I>& triangles)
{
    const std::size_t triangles_before = triangles.size();
    std::vector<std::size_t> left(flat.size());
    for (std::size_t k = 0; k < left.size(); ++k)
        left[k] = k;
    while (left.size() > 2) {
        const std::size_t n = left.size();
        // A simple polygon always has an ear; one that crosses itself need not.
        std::size_t k = 0;
        while (k < n && !is_ear(flat, polygon, left, k))
            ++k;
        if (k == n) {
            triangles.resize(triangles_before);
            return false;
        }
        triangles.emplace_back(polygon[left[(k + n - 1) % n]], polygon[left[k]],
                               polygon[left[(k + 1) % n]]);
        left.erase(left.begin() + static_cast<std::ptrdiff_t>(k));
    }
    return true;
}

} // namespace

void append_triangles(const std::vector<openvdb::Vec3s>& points, const Polygon& polygon,
                      std::vector<openvdb::Vec3I>& triangles)
{
    if (polygon.size() > 3 && polygon.size() <= kMostEarCorners) {
        const std::vector<Vec2d> flat = flattened(points, polygon);
        if (!is_convex(flat) && cut_ears(flat, polygon, triangles))
            return;
    }
    // From a corner that comes twice, a fan would have triangles of two corners.
    const std::size_t n = polygon.size(), apex = first_unique_corner(polygon);
    for (std::size_t k = apex + 1; k + 1 < apex + n; ++k)
        triangles.emplace_back(polygon[apex], polygon[k % n], polygon[(k + 1) % n]);
}

} // namespace vdb_shell
