// SPDX-License-Identifier: Apache-2.0

// The nearest point of one triangle, in doubles and rounded: good for measuring, no proof. If the
// foot of the perpendicular is beyond no side, it is the nearest; else the nearest point lies on a
// side, and the nearest of the three is taken. Ties go to the side with the smaller number, so the
// answer does not depend on anything else. Triangles without area, and sides without length, have
// an answer as well.

#include "mesh/nearest_on_triangle.h"

#include <algorithm>

namespace vdb_shell
{

using openvdb::Vec3d;

namespace
{

NearestOnTriangle nearest_on_side(const std::array<Vec3d, 3>& c, int k, const Vec3d& p)
{
    const auto i = static_cast<std::size_t>(k), j = (i + 1) % 3;
    const Vec3d e = c[j] - c[i];
    const double squared = e.lengthSqr(), along = squared > 0 ? (p - c[i]).dot(e) / squared : 0.0;
    if (along <= 0)
        return {c[i], NearestOnTriangle::On::corner, k};
    if (along >= 1)
        return {c[j], NearestOnTriangle::On::corner, static_cast<int>(j)};
    return {c[i] + along * e, NearestOnTriangle::On::side, k};
}

} // namespace

NearestOnTriangle nearest_on_triangle(const std::array<Vec3d, 3>& c, const Vec3d& p)
{
    const Vec3d n = (c[1] - c[0]).cross(c[2] - c[0]);
    const double squared = n.lengthSqr();
    // A triangle without a normal has no face to project into. Written so that it also holds for
    // what is not a number. A cross product of a side and the normal points outward in the plane,
    // because corners run counter-clockwise around the normal.
    bool beyond_any = !(squared > 0);
    for (std::size_t k = 0; k < 3; ++k)
        beyond_any = beyond_any || (c[(k + 1) % 3] - c[k]).cross(n).dot(p - c[k]) > 0;
    if (!beyond_any)
        return {p - (p - c[0]).dot(n) / squared * n, NearestOnTriangle::On::face, 0};
    NearestOnTriangle best = nearest_on_side(c, 0, p);
    for (int k = 1; k < 3; ++k) {
        const NearestOnTriangle other = nearest_on_side(c, k, p);
        if ((other.point - p).lengthSqr() < (best.point - p).lengthSqr())
            best = other;
    }
    return best;
}

std::array<double, 3> nearest_weights(const std::array<Vec3d, 3>& corner, const Vec3d& point)
{
    const Vec3d to = nearest_on_triangle(corner, point).point;
    const Vec3d u = corner[1] - corner[0], v = corner[2] - corner[0], w = to - corner[0];
    const double uu = u.dot(u), uv = u.dot(v), vv = v.dot(v), wu = w.dot(u), wv = w.dot(v);
    const double determinant = uu * vv - uv * uv;
    if (!(determinant > 0)) {
        // So narrow that doubles see a segment: the nearest corner.
        std::size_t nearest = 0;
        for (std::size_t k = 1; k < 3; ++k)
            if ((corner[k] - to).lengthSqr() < (corner[nearest] - to).lengthSqr())
                nearest = k;
        std::array<double, 3> at{};
        at[nearest] = 1;
        return at;
    }
    const double b = std::clamp((vv * wu - uv * wv) / determinant, 0.0, 1.0);
    const double c = std::clamp((uu * wv - uv * wu) / determinant, 0.0, 1.0 - b);
    return {1.0 - b - c, b, c};
}

} // namespace vdb_shell
