// SPDX-License-Identifier: Apache-2.0

// Signs and contacts, decided exactly on the float32 coordinates themselves. A float32 is a double
// without rounding, so CGAL's kernel gets exactly what is stored. Signs come from a filter in
// doubles where that is certain (Shewchuk, "Adaptive Precision Floating-Point Arithmetic and Fast
// Robust Geometric Predicates", 1997), else from CGAL's filtered predicates, which turn to exact
// numbers in the end. No intersection is ever constructed: constructions of this kernel are
// rounded, only its predicates are exact. Trap: CGAL's tests of intersection want triangles and
// segments that are not degenerate; callers, or the functions below, see to that.

#include "core/exact.h"

#include "core/orient3d_filter.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Exact_rational.h>
#include <CGAL/intersections.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>

namespace vdb_shell::exact
{
namespace
{

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point2 = Kernel::Point_2;
using Point3 = Kernel::Point_3;
using Segment = Kernel::Segment_3;
using Triangle3 = Kernel::Triangle_3;

Point3 point3(const openvdb::Vec3s& p)
{
    return {p[0], p[1], p[2]};
}
Point2 point2(const openvdb::Vec3s& p)
{
    return {p[0], p[1]};
}

struct SharedCorners {
    int count = 0;
    std::array<int, 3> in_first{}, in_second{}; ///< shared corners first, then the others
};

SharedCorners match_corners(const openvdb::Vec3I& first, const openvdb::Vec3I& second)
{
    SharedCorners shared;
    std::array<bool, 3> first_used{}, second_used{};
    for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j) {
            if (first[i] != second[j])
                continue;
            const auto slot = static_cast<std::size_t>(shared.count++);
            shared.in_first[slot] = i;
            shared.in_second[slot] = j;
            first_used[static_cast<std::size_t>(i)] = second_used[static_cast<std::size_t>(j)] =
                true;
        }
    }
    auto append_unused = [&](std::array<int, 3>& corners, const std::array<bool, 3>& used) {
        auto slot = static_cast<std::size_t>(shared.count);
        for (int i = 0; i < 3; ++i)
            if (!used[static_cast<std::size_t>(i)])
                corners[slot++] = i;
    };
    append_unused(shared.in_first, first_used);
    append_unused(shared.in_second, second_used);
    return shared;
}

} // namespace

int orient3d(const openvdb::Vec3s& a, const openvdb::Vec3s& b, const openvdb::Vec3s& c,
             const openvdb::Vec3s& d)
{
    if (const int sign = orient3d_filter(openvdb::Vec3d(a), openvdb::Vec3d(b), openvdb::Vec3d(c),
                                         openvdb::Vec3d(d)))
        return sign;
    return static_cast<int>(CGAL::orientation(point3(a), point3(b), point3(c), point3(d)));
}

bool collinear(const openvdb::Vec3s& a, const openvdb::Vec3s& b, const openvdb::Vec3s& c)
{
    return CGAL::collinear(point3(a), point3(b), point3(c));
}

namespace
{

using Point = std::array<double, 2>;

/// Sign of det(b - a, c - a) where doubles decide it for certain, else 0 (Shewchuk 1997, bound A of
/// ORIENT2D).
int orient2d_filter(const Point& a, const Point& b, const Point& c)
{
    constexpr double kError = 3.4e-16;
    const double left = (b[0] - a[0]) * (c[1] - a[1]), right = (b[1] - a[1]) * (c[0] - a[0]);
    return certain_sign(left - right, std::abs(left) + std::abs(right), kError);
}

/// Whether the line of an edge of s has s on one side and t, but for corners that it shares with
/// that edge, strictly on the other.
bool edge_separates(const std::array<Point, 3>& s, const openvdb::Vec3I& s_id,
                    const std::array<Point, 3>& t, const openvdb::Vec3I& t_id)
{
    for (std::size_t i = 0; i < 3; ++i) {
        const std::size_t j = (i + 1) % 3;
        const int own = orient2d_filter(s[i], s[j], s[(i + 2) % 3]);
        bool apart = own != 0;
        for (std::size_t k = 0; apart && k < 3; ++k) {
            const std::uint32_t id = t_id[int(k)];
            apart = id == s_id[int(i)] || id == s_id[int(j)] ||
                    orient2d_filter(s[i], s[j], t[k]) == -own;
        }
        if (apart)
            return true;
    }
    return false;
}

// Seen along this axis a triangle appears as large as along any, so it is least likely to look
// flat.
int largest_axis(const openvdb::Vec3d& n)
{
    const double x = std::abs(n[0]), y = std::abs(n[1]), z = std::abs(n[2]);
    return x >= y && x >= z ? 0 : y >= z ? 1 : 2;
}

} // namespace

bool apart_in_projection(const std::vector<openvdb::Vec3s>& points, const openvdb::Vec3I& first,
                         const openvdb::Vec3I& second)
{
    const openvdb::Vec3d a(points[first[0]]), b(points[first[1]]), c(points[first[2]]);
    // The normal is rounded, which does no harm: any axis would be right, since a line that
    // separates what is seen is a plane, along the axis, that separates in space. In that plane `s`
    // has its edge only, and of `t` there are only corners that both share.
    const int axis = largest_axis((b - a).cross(c - a));
    const auto seen = [&](const openvdb::Vec3I& triangle) {
        std::array<Point, 3> corners;
        for (int k = 0; k < 3; ++k) {
            const openvdb::Vec3s& p = points[triangle[k]];
            corners[std::size_t(k)] = {double(p[(axis + 1) % 3]), double(p[(axis + 2) % 3])};
        }
        return corners;
    };
    const std::array<Point, 3> s = seen(first), t = seen(second);
    return edge_separates(s, first, t, second) || edge_separates(t, second, s, first);
}

namespace
{

bool is_corner_of(const openvdb::Vec3I& face, std::uint32_t point)
{
    return face[0] == point || face[1] == point || face[2] == point;
}

/// Whether all corners of `other` that are not shared lie strictly on one side of the plane of
/// `face`: then the two meet in shared corners and edges only.
bool plane_separates(const std::vector<openvdb::Vec3s>& points, const openvdb::Vec3I& face,
                     const openvdb::Vec3I& other)
{
    int side = 0;
    for (int k = 0; k < 3; ++k) {
        if (is_corner_of(face, other[k]))
            continue;
        const int sign =
            orient3d(points[face[0]], points[face[1]], points[face[2]], points[other[k]]);
        // Only strictly on one side: a corner in the plane could lie in the triangle itself. A
        // degenerate face gives zeros only and is never said to separate.
        if (sign == 0 || sign == -side)
            return false;
        side = sign;
    }
    return side != 0;
}

/// Whether corners of different index stand in one place, as where a surface was cut open. No
/// filter in doubles decides such pairs, as all signs there are zero.
bool have_equal_corners(const std::vector<openvdb::Vec3s>& points, const openvdb::Vec3I& first,
                        const openvdb::Vec3I& second)
{
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
            if (first[i] != second[j] && points[first[i]] == points[second[j]])
                return true;
    return false;
}

} // namespace

bool triangles_touch(const std::vector<openvdb::Vec3s>& points, const openvdb::Vec3I& first,
                     const openvdb::Vec3I& second)
{
    // Quick tests come first. Each answers only where it is certain, so their order changes the
    // time and not the answer.
    if (have_equal_corners(points, first, second))
        return true;
    if (apart_in_projection(points, first, second) || plane_separates(points, first, second) ||
        plane_separates(points, second, first))
        return false;
    const SharedCorners shared = match_corners(first, second);
    auto p = [&](std::size_t slot) { return point3(points[first[shared.in_first[slot]]]); };
    auto q = [&](std::size_t slot) { return point3(points[second[shared.in_second[slot]]]); };
    switch (shared.count) {
    case 0:
        return CGAL::do_intersect(Triangle3(p(0), p(1), p(2)), Triangle3(q(0), q(1), q(2)));
    case 1:
        // The common part is convex and holds the shared corner. If it holds another point, the ray
        // from the corner through that point lies in both triangles until it leaves one of them,
        // and it leaves that one through the edge opposite to the corner.
        return CGAL::do_intersect(Segment(p(1), p(2)), Triangle3(q(0), q(1), q(2))) ||
               CGAL::do_intersect(Segment(q(1), q(2)), Triangle3(p(0), p(1), p(2)));
    case 2:
        // Triangles with a common edge lie in two half-planes that begin at it. These meet in the
        // edge's line only, unless they are the same half-plane.
        return CGAL::orientation(p(0), p(1), p(2), q(2)) == CGAL::COPLANAR &&
               CGAL::coplanar_orientation(p(0), p(1), p(2), q(2)) == CGAL::POSITIVE;
    default:
        return true;
    }
}

namespace
{

bool degenerate(const Triangle& t)
{
    return collinear(t[0], t[1], t[2]);
}
Triangle3 triangle3(const Triangle& t)
{
    return {point3(t[0]), point3(t[1]), point3(t[2])};
}

} // namespace

bool triangles_touch(const Triangle& first, const Triangle& second)
{
    return degenerate(first) || degenerate(second) ||
           CGAL::do_intersect(triangle3(first), triangle3(second));
}

bool segment_touches_triangle(const openvdb::Vec3s& p, const openvdb::Vec3s& q,
                              const Triangle& triangle)
{
    return p == q || degenerate(triangle) ||
           CGAL::do_intersect(Segment(point3(p), point3(q)), triangle3(triangle));
}

namespace
{

/// Corners 0 to 3 are the first tet's, 4 to 7 the second's.
using EightCorners = std::array<openvdb::Vec3s, 8>;

/// Whether the plane through three of the corners has the tets on different sides. Three corners on
/// one line span none: then all signs are 0.
bool plane_separates(const EightCorners& corner, std::size_t i, std::size_t j, std::size_t k)
{
    std::array<int, 2> side{};
    for (std::size_t x = 0; x < corner.size(); ++x) {
        const openvdb::Vec3s& p = corner[x];
        // Shared corners lie in the plane; exact arithmetic is not needed to see it.
        if (p == corner[i] || p == corner[j] || p == corner[k])
            continue;
        const int sign = orient3d(corner[i], corner[j], corner[k], p);
        // A side that both tets have corners on, or one tet on both sides, rules the plane out.
        // Corners in the plane are allowed: it is the interiors that must be disjoint.
        int& own = side[x / 4];
        if (sign * own < 0 || sign * side[1 - x / 4] > 0)
            return false;
        if (sign != 0)
            own = sign;
    }
    return side[0] != 0 || side[1] != 0;
}

} // namespace

bool tets_overlap(const Tet& first, const Tet& second)
{
    EightCorners corner;
    std::copy(first.begin(), first.end(), corner.begin());
    std::copy(second.begin(), second.end(), corner.begin() + 4);
    // Of the planes through three corners those of faces come first, because they separate most
    // pairs (docs/theory.md, "A surface that crosses itself", proves that the planes through
    // corners are enough).
    for (std::size_t base = 0; base < 8; base += 4)
        for (std::size_t left_out = 0; left_out < 4; ++left_out)
            if (plane_separates(corner, base + (left_out + 1) % 4, base + (left_out + 2) % 4,
                                base + (left_out + 3) % 4))
                return false;
    // The 48 planes through corners of both tets, which together with the 8 faces are all 56. They
    // are needed: two tets may cross like two knives, where no face separates.
    for (std::size_t i = 0; i < 4; ++i)
        for (std::size_t j = i + 1; j < 8; ++j)
            for (std::size_t k = std::max<std::size_t>(j + 1, 4); k < 8; ++k)
                if (plane_separates(corner, i, j, k))
                    return false;
    return true;
}

int turn_along(int axis, const openvdb::Vec3s& a, const openvdb::Vec3s& b, const openvdb::Vec3s& c)
{
    const int u = (axis + 1) % 3, v = (axis + 2) % 3;
    const auto seen = [&](const openvdb::Vec3s& p) { return Point2(p[u], p[v]); };
    return static_cast<int>(CGAL::orientation(seen(a), seen(b), seen(c)));
}

bool on_one_side(const openvdb::Vec3s& a, const openvdb::Vec3s& b, const openvdb::Vec3s& p,
                 const openvdb::Vec3s& q)
{
    return CGAL::coplanar_orientation(point3(a), point3(b), point3(p), point3(q)) != CGAL::NEGATIVE;
}

bool longer_than(const openvdb::Vec3s& from, const openvdb::Vec3s& to, double length)
{
    // Double arithmetic is off by a few units in the last place, of about 1e-16 each. Only lengths
    // that are nearly the same need more.
    constexpr double kSlack = 1e-14;
    const double measured = (openvdb::Vec3d(to) - openvdb::Vec3d(from)).length();
    assert(std::isfinite(measured));
    if (measured > length)
        return true;
    if (measured < length * (1 - kSlack))
        return false;
    CGAL::Exact_rational squared = 0;
    for (int axis = 0; axis < 3; ++axis) {
        const CGAL::Exact_rational extent =
            CGAL::Exact_rational(to[axis]) - CGAL::Exact_rational(from[axis]);
        // Squares are compared, because a root is no rational number.
        squared += extent * extent;
    }
    return squared > CGAL::Exact_rational(length) * CGAL::Exact_rational(length);
}

namespace
{

/// For the half-open rule: whether the directed edge a->b, seen from above, passes the point on its
/// positive-x side while crossing the point's y. A vertex at exactly the point's y counts as below
/// it, so that consecutive edges agree.
bool crosses_ray(const Point2& p, const Point2& a, const Point2& b)
{
    const bool a_above = a.y() > p.y(), b_above = b.y() > p.y();
    if (a_above == b_above)
        return false;
    // Both triangles at an edge get the same answer, also where the point is on the edge's line:
    // turned round, the edge has the other orientation and the other test. So a line through the
    // edge is counted for exactly one of two triangles that lie on either side of it.
    const CGAL::Orientation side = CGAL::orientation(a, b, p);
    return b_above ? side == CGAL::LEFT_TURN : side == CGAL::RIGHT_TURN;
}

} // namespace

int crossing_above(const openvdb::Vec3s& point, const openvdb::Vec3s& a, const openvdb::Vec3s& b,
                   const openvdb::Vec3s& c, bool& on_surface)
{
    // A corner is on the triangle, and no line from there crosses it. Filters do not decide that,
    // and pieces that share a corner ask for it once a pair.
    if (point == a || point == b || point == c) {
        on_surface = on_surface || !collinear(a, b, c);
        return 0;
    }
    const Point2 p = point2(point), pa = point2(a), pb = point2(b), pc = point2(c);
    const CGAL::Orientation turn = CGAL::orientation(pa, pb, pc);
    const int side = orient3d(a, b, c, point); // < 0: the point lies behind the triangle
    if (side == 0 && !collinear(a, b, c)) {
        const Triangle3 triangle(point3(a), point3(b), point3(c));
        on_surface = on_surface || triangle.has_on(point3(point));
    }
    // A triangle seen edge on has no inside that the line could cross. By the half-open rule its
    // neighbours count the line as if it were not there, because its edges are theirs too.
    if (turn == CGAL::COLLINEAR)
        return 0;
    const bool inside = crosses_ray(p, pa, pb) ^ crosses_ray(p, pb, pc) ^ crosses_ray(p, pc, pa);
    if (!inside)
        return 0;
    const int up = turn == CGAL::LEFT_TURN ? 1 : -1;
    return side == -up ? up : 0;
}

} // namespace vdb_shell::exact
