// SPDX-License-Identifier: Apache-2.0

// Takes: a valid state and a place for one inner point, or one prism. Gives: whether the shell is
// valid with it, by the exact tests that every accepted move passes: tets positive, cap kept, no
// contact, no component enclosed. Doubles decide nearly all of them for certain, several at a time;
// what they leave open goes to the exact predicates. Which conditions these are: docs/theory.md,
// "The whole shell". Nothing is changed here, and a test reads no vertex more than two edges away,
// on which the colouring rests. The place has to be rounded to float32 before: another point would
// be tested than the one that is stored.

#include "growth/move_tests.h"

#include "core/orient3d_filter.h"
#include "growth/prism_lanes.h"
#include "shell/pillar.h"

#include <algorithm>

namespace vdb_shell::growth
{
namespace
{

/// The tets of a prism that hold b_l, under the state's present rule.
Slice<TetFromInner> tets_with_inner(const GrowState& s, int f, int l)
{
    if (!s.twelve)
        return chosen_tets_with_inner(s, f, l);
    const TetFromInner* first = tables().from_b[kTwelve][l].data();
    return {first, first + tables().from_b_count[kTwelve][l]};
}

bool positive(const GrowState& s, int f, const OrientedTet& tet)
{
    return dropped(s, f, tet.pillar) ||
           orient(corner_of(s, f, tet.corner[0]), corner_of(s, f, tet.corner[1]),
                  corner_of(s, f, tet.corner[2]), corner_of(s, f, tet.corner[3])) > 0;
}

/// Inner triangle `moved` against those around its corner u that hold neither v nor `done`, whose
/// triangles have been tested already; where u is pinned also against the outer ones: there both
/// surfaces have the corner u, and pairs with a common corner have no separating plane.
bool adjacent_clear_around(const GrowState& s, int v, const InnerTriangle& moved, int u, int done)
{
    const Connectivity& m = *s.mesh;
    for (const FaceCorner& at : star(m, u)) {
        const int g = at.face;
        if (!m.incident_to(g, v) && (done < 0 || !m.incident_to(g, done)) && moved.meets_inner(g))
            return false;
        if (s.pinned[u] && moved.meets_outer(g))
            return false;
    }
    return true;
}

/// The corners of an inner triangle with b_v = x.
Corners corners_with(const GrowState& s, int f, int v, const Vec3d& x)
{
    Corners corners = inner_corners(s, f);
    for (int k = 0; k < 3; ++k)
        if (s.mesh->corner(f, k) == v)
            corners[k] = x;
    return corners;
}

/// The inner triangles around v against the others around u, which is v or beside it, pair by pair:
/// for fans that are not closed, or have more triangles than Fan holds.
bool clear_around_by_pairs(const GrowState& s, int u, int v, const Vec3d& x)
{
    for (const FaceCorner& at : star(*s.mesh, u)) {
        const int f = at.face;
        if (!s.mesh->incident_to(f, v))
            continue;
        const Corners of_f = corners_with(s, f, v, x);
        for (const FaceCorner& other : star(*s.mesh, u))
            if (other.face != f &&
                improper_contact(of_f, inner_ids(s, f), corners_with(s, other.face, v, x),
                                 inner_ids(s, other.face)))
                return false;
    }
    return true;
}

/// Pair by pair the middle of a cylinder's cap would take time by the square of its triangles.
bool large_inner_fan_surely_embedded(const GrowState& s, int u, int v, const Vec3d& x)
{
    const VertexTriangles::Range rim = s.mesh->rims.of(static_cast<std::size_t>(u));
    const auto inner = [&](int w) -> const Vec3d& { return w == v ? x : s.b[w]; };
    return rim.size() > Fan::kMost &&
           large_fan_surely_embedded(inner(u), rim.size(), [&](std::size_t i) -> const Vec3d& {
               return inner(static_cast<int>(rim.first[i]));
           });
}

/// The same; nearly always doubles show it for all of them at once.
bool clear_around(const GrowState& s, int u, int v, const Vec3d& x)
{
    Fan fan;
    const VertexTriangles::Range rim = s.mesh->rims.of(static_cast<std::size_t>(u));
    const std::size_t count = rim.size();
    if (!set_inner_fan(s, u, v, x, fan))
        return large_inner_fan_surely_embedded(s, u, v, x) || clear_around_by_pairs(s, u, v, x);
    if (fan.surely_embedded())
        return true;
    const auto vertex = [&](std::size_t i) {
        return static_cast<int>(rim.first[i < count ? i : 0]);
    };
    const auto inner = [&](int w) -> const Vec3d& { return w == v ? x : s.b[w]; };
    // All of these are inner triangles, so the index of a vertex names its corner, pinned or not.
    const auto ids = [&](std::size_t i) -> CornerIds { return {u, vertex(i), vertex(i + 1)}; };
    const auto corners = [&](std::size_t i) -> Corners {
        return {inner(u), inner(vertex(i)), inner(vertex(i + 1))};
    };
    for (std::size_t i = 0; i < count; ++i) {
        // Triangles that do not hold v have not moved, and were clear of each other before.
        if (u != v && vertex(i) != v && vertex(i + 1) != v)
            continue;
        // Around v itself all triangles have moved, and each pair is tested once. Around a
        // neighbour two have, and each is tested against all others.
        const std::uint32_t apart = fan.surely_apart_from(i);
        for (std::size_t j = u == v ? i + 1 : 0; j < count; ++j)
            if (i != j && (apart >> j & 1U) == 0 &&
                improper_contact(corners(i), ids(i), corners(j), ids(j)))
                return false;
    }
    return true;
}

/// adjacent_clear_at beside a pin, where outer triangles share corners with inner ones too.
bool adjacent_clear_beside_a_pin(const GrowState& s, int v, const Vec3d& x)
{
    const Connectivity& m = *s.mesh;
    const Slice<FaceCorner> fan = star(m, v);
    for (const FaceCorner& at : fan) {
        const InnerTriangle moved(s, at, x);
        for (const FaceCorner& other : fan)
            if (other.face > at.face && moved.meets_inner(other.face, moved_corners(s, other, x)))
                return false;
        const int next = m.corner(at.face, (at.local + 1) % 3);
        for (const int u : {next, m.corner(at.face, (at.local + 2) % 3)})
            if (!adjacent_clear_around(s, v, moved, u, u == next ? -1 : next))
                return false;
    }
    return true;
}

} // namespace

bool set_inner_fan(const GrowState& s, int u, int v, const Vec3d& x, Fan& fan)
{
    const VertexTriangles::Range rim = s.mesh->rims.of(static_cast<std::size_t>(u));
    if (rim.size() < 3 || rim.size() > Fan::kMost)
        return false;
    const auto inner = [&](int w) -> const Vec3d& { return w == v ? x : s.b[w]; };
    fan.set(inner(u), rim.size(),
            [&](std::size_t i) -> const Vec3d& { return inner(static_cast<int>(rim.first[i])); });
    return true;
}

Corners moved_corners(const GrowState& s, const FaceCorner& at, const Vec3d& x)
{
    Corners corners = inner_corners(s, at.face);
    corners[at.local] = x;
    return corners;
}

bool tets_positive_at(const GrowState& s, int v, const Vec3d& x)
{
    for (const FaceCorner& at : star(*s.mesh, v)) {
        // The lanes also test tets of dropped pillars, which are flat. So beside a pin they never
        // say yes, and each tet that exists is tested by itself.
        if (s.twelve && surely_positive(prism_around(s, at), x.asPointer()))
            continue;
        for (const TetFromInner& tet : tets_with_inner(s, at.face, at.local))
            if (!dropped(s, at.face, tet.pillar) &&
                orient(corner_of(s, at.face, tet.base[0]), corner_of(s, at.face, tet.base[1]),
                       corner_of(s, at.face, tet.base[2]), x) <= 0)
                return false;
    }
    return true;
}

bool within_cap(const GrowState& s, int v, const Vec3d& x)
{
    return !exact::longer_than(Vec3s(s.a[v]), Vec3s(x), s.cap[v]);
}

Vec3d end_within_cap(const GrowState& s, int v, const Vec3d& unit, double length)
{
    const Vec3d x = rounded(s.a[v] + std::min(length, s.cap[v]) * unit);
    // Rounding may have made the pillar longer than the cap, which is exact. Only then is the end
    // stepped back, float by float.
    return within_cap(s, v, x) ? x : Vec3d(end_of_pillar(Vec3s(s.a[v]), unit, s.cap[v]));
}

Vec3d capped(const GrowState& s, int v, const Vec3d& x)
{
    const Vec3d point = rounded(x);
    if (within_cap(s, v, point))
        return point;
    // Along the radius: that is the nearest point of the ball around the outer point.
    const Vec3d arm = x - s.a[v];
    return end_within_cap(s, v, arm / arm.length(), s.cap[v]);
}

int failing_tets(const GrowState& s, int f, int order)
{
    const std::array<OrientedTet, 3>& tets = tables().three[order];
    return static_cast<int>(std::count_if(
        tets.begin(), tets.end(), [&](const OrientedTet& tet) { return !positive(s, f, tet); }));
}

bool split_positive(const GrowState& s, int f, int order)
{
    const std::array<OrientedTet, 3>& tets = tables().three[order];
    return std::all_of(tets.begin(), tets.end(),
                       [&](const OrientedTet& tet) { return positive(s, f, tet); });
}

namespace
{

/// Whether doubles show that all twelve tets are positive: each holds an inner point. Never beside
/// a pin, where some are flat.
bool surely_all_positive(const GrowState& s, int f)
{
    for (int k = 0; k < 3; ++k)
        if (!surely_positive(prism_around(s, {f, k}), s.b[s.mesh->corner(f, k)].asPointer()))
            return false;
    return true;
}

/// Whether these tets are positive, and the inner triangle has area.
bool valid_with(const GrowState& s, int f, const Slice<OrientedTet>& tets)
{
    for (const OrientedTet& tet : tets)
        if (!positive(s, f, tet))
            return false;
    // Positive tets show that their faces have area. With a pin the tet that holds the whole inner
    // triangle may have been dropped, so a triangle without area has to be looked for.
    const bool pins = dropped(s, f, 0) || dropped(s, f, 1) || dropped(s, f, 2);
    const Corners b = inner_corners(s, f);
    return !pins || !exact::collinear(Vec3s(b[0]), Vec3s(b[1]), Vec3s(b[2]));
}

} // namespace

bool prism_valid(const GrowState& s, int f)
{
    return s.twelve ? twelve_tets_valid(s, f) : valid_with(s, f, tested_tets(s, f));
}

bool twelve_tets_valid(const GrowState& s, int f)
{
    return surely_all_positive(s, f) || valid_with(s, f, all_tets());
}

bool inner_triangle_clear(const GrowState& s, int f)
{
    const InnerTriangle triangle(s, f);
    const FloatBox box = float_box_of(triangle.corners());
    bool clear = true;
    s.inner_tree.for_each_overlap_while(
        box, [&](int g) { return clear = g == f || !triangle.meets_inner(g); });
    if (clear)
        s.outer_tree.for_each_overlap_while(
            box, [&](int g) { return clear = !triangle.meets_outer(g); });
    return clear;
}

InnerTriangle::InnerTriangle(const GrowState& s, int f)
    : s_(s), face_(f), corners_(inner_corners(s, f)), plane_(corners_[0], corners_[1], corners_[2])
{
}

InnerTriangle::InnerTriangle(const GrowState& s, const FaceCorner& at, const Vec3d& x)
    : s_(s), face_(at.face), corners_(moved_corners(s, at, x)),
      plane_(corners_[0], corners_[1], corners_[2])
{
}

bool InnerTriangle::meets_inner(int g, const Corners& c) const
{
    // If all corners of the other triangle that are not common lie strictly on one side of this
    // one's plane, nothing but the common corners is in both. The plane is computed once for all
    // triangles that this one is held against; what it leaves open goes to the exact test.
    int first = 0;
    bool one_side = true;
    for (int k = 0; k < 3; ++k) {
        if (s_.mesh->incident_to(face_, s_.mesh->corner(g, k)))
            continue;
        const int side = plane_.side(c[k]);
        one_side = one_side && side != 0 && (first == 0 || side == first);
        first = side;
    }
    return !one_side && !excused(g) &&
           improper_contact(corners_, inner_ids(s_, face_), c, inner_ids(s_, g));
}

bool InnerTriangle::meets_outer(int g) const
{
    return !excused(g) &&
           improper_contact(corners_, inner_ids(s_, face_), outer_corners(s_, g), outer_ids(s_, g));
}

void tet_bounds(const GrowState& s, int v, LinearBounds& out)
{
    const Connectivity& m = *s.mesh;
    for (const FaceCorner& at : star(m, v)) {
        const int next = m.corner(at.face, (at.local + 1) % 3);
        const int last = m.corner(at.face, (at.local + 2) % 3);
        if (s.twelve && !s.pinned[next] && !s.pinned[last]) {
            out.add_prism({s.a[v], s.a[next], s.a[last], s.b[next], s.b[last]});
            continue;
        }
        for_each_base(s, at.face, tets_with_inner(s, at.face, at.local),
                      [&](const Vec3d& n, const Vec3d& p) { out.add(n, p); });
    }
}

bool beside_a_pin(const GrowState& s, int v)
{
    const Slice<int> around = neighbours(*s.mesh, v);
    return std::any_of(around.begin(), around.end(), [&](int u) { return s.pinned[u] != 0; });
}

bool inner_fan_surely_embedded(const GrowState& s, int u)
{
    Fan fan;
    return set_inner_fan(s, u, u, s.b[u], fan) ? fan.surely_embedded()
                                               : large_inner_fan_surely_embedded(s, u, u, s.b[u]);
}

bool adjacent_clear_at(const GrowState& s, int v, const Vec3d& x)
{
    if (beside_a_pin(s, v))
        return adjacent_clear_beside_a_pin(s, v, x);
    // Triangles with a common corner are both in the fan of that corner (docs/theory.md, "Fans"),
    // and a triangle around v has its corners at v and at neighbours of v. Triangles without one
    // are kept apart by separating planes.
    const auto clear = [&](int u) { return clear_around(s, u, v, x); };
    const Slice<int> around = neighbours(*s.mesh, v);
    return clear(v) && std::all_of(around.begin(), around.end(), clear);
}

} // namespace vdb_shell::growth
