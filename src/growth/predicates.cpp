// SPDX-License-Identifier: Apache-2.0

// Contacts of triangles by signs of determinants. Doubles decide nearly all signs for certain; what
// they leave open goes to core/exact.h, so every answer is that of the float32 coordinates as they
// are stored. What counts as a contact: docs/theory.md, "The whole shell".

#include "growth/predicates.h"

namespace vdb_shell::growth
{

namespace
{

exact::Triangle exact_triangle(const Corners& t)
{
    return {Vec3s(t[0]), Vec3s(t[1]), Vec3s(t[2])};
}

} // namespace

bool segment_touches_triangle(const Vec3d& p, const Vec3d& q, const Corners& t)
{
    const int sp = orient(t[0], t[1], t[2], p);
    const int sq = orient(t[0], t[1], t[2], q);
    if (sp * sq > 0)
        return false;
    if (sp == 0 || sq == 0)
        return exact::segment_touches_triangle(Vec3s(p), Vec3s(q), exact_triangle(t));
    // The ends lie strictly on either side, so the line of the segment meets the plane in one point
    // within the segment. That is in the triangle when the line passes no two edges on opposite
    // sides; a sign of nought means that it meets the edge.
    const int e0 = orient(p, q, t[0], t[1]);
    const int e1 = orient(p, q, t[1], t[2]);
    if (e0 * e1 < 0)
        return false;
    const int e2 = orient(p, q, t[2], t[0]);
    return e2 * e0 >= 0 && e2 * e1 >= 0;
}

namespace
{

/// On which sides of t's plane the corners of s lie.
std::array<int, 3> sides_of(const Corners& s, const Corners& t)
{
    return {orient(t[0], t[1], t[2], s[0]), orient(t[0], t[1], t[2], s[1]),
            orient(t[0], t[1], t[2], s[2])};
}

bool all_on_one_side(const std::array<int, 3>& side)
{
    return side[0] == side[1] && side[1] == side[2] && side[0] != 0;
}

bool separate_triangles_touch(const Corners& s, const Corners& t)
{
    const std::array<int, 3> a = sides_of(s, t);
    if (all_on_one_side(a))
        return false;
    const std::array<int, 3> b = sides_of(t, s);
    if (all_on_one_side(b))
        return false;
    for (int i = 0; i < 3; ++i)
        if (a[i] == 0 || b[i] == 0)
            return exact::triangles_touch(exact_triangle(s), exact_triangle(t));
    // No corner lies in the other's plane, so each triangle crosses that plane with two edges: if
    // the triangles meet, an edge of one pierces the other, and an edge with both ends on one side
    // cannot.
    for (int i = 0; i < 3; ++i) {
        const int j = (i + 1) % 3;
        if (a[i] != a[j] && segment_touches_triangle(s[i], s[j], t))
            return true;
        if (b[i] != b[j] && segment_touches_triangle(t[i], t[j], s))
            return true;
    }
    return false;
}

/// Whether the corners of s other than `shared` lie on the same side of t's plane, none in it.
bool rest_on_one_side(const Corners& s, int shared, const Corners& t)
{
    const int one = orient(t[0], t[1], t[2], s[(shared + 1) % 3]);
    return one != 0 && orient(t[0], t[1], t[2], s[(shared + 2) % 3]) == one;
}

} // namespace

bool improper_contact(const Corners& s, const CornerIds& s_id, const Corners& t,
                      const CornerIds& t_id)
{
    int shared = 0, si = 0, ti = 0;
    std::array<bool, 3> s_shared{}, t_shared{};
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
            if (s_id[i] == t_id[j]) {
                ++shared, si = i, ti = j;
                s_shared[i] = t_shared[j] = true;
            }
    if (shared == 0)
        return separate_triangles_touch(s, t);
    // With one triangle but for the shared corner on one side of the other's plane, only that
    // corner lies in both.
    if (shared == 1 && (rest_on_one_side(s, si, t) || rest_on_one_side(t, ti, s)))
        return false;
    if (shared == 1)
        // Follow, from the common corner, a ray that stays in both triangles: the first of them to
        // end does so on its edge across from that corner, and there that edge meets the other
        // triangle.
        return segment_touches_triangle(s[(si + 1) % 3], s[(si + 2) % 3], t) ||
               segment_touches_triangle(t[(ti + 1) % 3], t[(ti + 2) % 3], s);
    // One and the same triangle: all three corners are pinned.
    if (shared == 3)
        return false;
    int so = 0, to = 0;
    for (int i = 0; i < 3; ++i) {
        if (!s_shared[i])
            so = i;
        if (!t_shared[i])
            to = i;
    }
    // Two triangles at an edge meet elsewhere only if they are folded flat onto each other.
    if (orient(s[0], s[1], s[2], t[to]) != 0)
        return false;
    return exact::on_one_side(Vec3s(s[(so + 1) % 3]), Vec3s(s[(so + 2) % 3]), Vec3s(s[so]),
                              Vec3s(t[to]));
}

} // namespace vdb_shell::growth
