// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/fan.h"
#include "growth/barrier.h"
#include "growth/grow_state.h"
#include "growth/prism_lanes.h"

namespace vdb_shell::growth
{

/// The prism of a face around one of its corners' inner points.
inline PrismAround prism_around(const GrowState& s, const FaceCorner& at)
{
    const int v = s.mesh->corner(at.face, at.local);
    const int next = s.mesh->corner(at.face, (at.local + 1) % 3),
              last = s.mesh->corner(at.face, (at.local + 2) % 3);
    return {s.a[v].asPointer(), s.a[next].asPointer(), s.a[last].asPointer(), s.b[next].asPointer(),
            s.b[last].asPointer()};
}

/// The tets of the prism's present split that hold inner corner `local` of face f.
inline Slice<TetFromInner> chosen_tets_with_inner(const GrowState& s, int f, int local)
{
    const TetFromInner* first = tables().from_b[s.order[f]][local].data();
    return {first, first + tables().from_b_count[s.order[f]][local]};
}

/// Calls visit(n, p) for each of these tets of face f that exists: it is positive where the inner
/// point that they hold lies on the side of n from p.
template <class Visit>
void for_each_base(const GrowState& s, int f, const Slice<TetFromInner>& tets, Visit&& visit)
{
    for (const TetFromInner& tet : tets) {
        if (dropped(s, f, tet.pillar))
            continue;
        const Vec3d& p = corner_of(s, f, tet.base[0]);
        const Vec3d u = corner_of(s, f, tet.base[1]) - p, w = corner_of(s, f, tet.base[2]) - p;
        visit(u.cross(w), p);
    }
}

/// All twelve tets of a prism.
inline Slice<OrientedTet> all_tets()
{
    return {tables().twelve.data(), tables().twelve.data() + tables().twelve.size()};
}
/// The tets of the prism of face f that the state's present rule is about.
inline Slice<OrientedTet> tested_tets(const GrowState& s, int f)
{
    if (s.twelve)
        return all_tets();
    const std::array<OrientedTet, 3>& chosen = tables().three[s.order[f]];
    return {chosen.data(), chosen.data() + chosen.size()};
}

/// Would the tets of the prisms around v be positive with b_v = x? Exact.
bool tets_positive_at(const GrowState& s, int v, const Vec3d& x);

/// The corners of an inner triangle when its corner `at` is at x.
Corners moved_corners(const GrowState& s, const FaceCorner& at, const Vec3d& x);

/// |x - a_v| <= cap_v, exactly.
bool within_cap(const GrowState& s, int v, const Vec3d& x);

/// The point at `length` from a_v towards `unit`, rounded so that the cap holds.
Vec3d end_within_cap(const GrowState& s, int v, const Vec3d& unit, double length);

/// The float32 point nearest x that respects the cap.
Vec3d capped(const GrowState& s, int v, const Vec3d& x);

/// All tets of face f positive (under s.twelve or its order), and its inner triangle not
/// degenerate.
bool prism_valid(const GrowState& s, int f);
/// The same under the twelve-tet test, whatever the state's rule is.
bool twelve_tets_valid(const GrowState& s, int f);
/// How many of the three chosen tets of face f would not be positive with this order. Exact.
int failing_tets(const GrowState& s, int f, int order);
/// Whether all of them would be.
bool split_positive(const GrowState& s, int f, int order);
/// Whether inner triangle f is free of improper contact with every other triangle. Precondition:
/// the inner tree's boxes hold the triangles.
bool inner_triangle_clear(const GrowState& s, int f);

/// An inner triangle that is held against others, one after another; with `x`, as it is when its
/// corner `local` is there.
class InnerTriangle
{
public:
    InnerTriangle(const GrowState& s, int f);
    InnerTriangle(const GrowState& s, const FaceCorner& at, const Vec3d& x);

    int face() const { return face_; }
    const Corners& corners() const { return corners_; }
    /// Improper contact with inner triangle g, or with what it is when its corners are c. Exact.
    bool meets_inner(int g) const { return meets_inner(g, inner_corners(s_, g)); }
    bool meets_inner(int g, const Corners& c) const;
    bool meets_outer(int g) const;

private:
    bool excused(int g) const { return !s_.excused.empty() && s_.excused[face_] && s_.excused[g]; }

    const GrowState& s_;
    int face_;
    Corners corners_;
    exact::PlaneFilter plane_;
};

/// Appends the linear bounds that the tets around v put on b_v.
void tet_bounds(const GrowState& s, int v, LinearBounds& out);

bool beside_a_pin(const GrowState& s, int v);

/// The inner triangles around u, with b_v = x; false where they are no closed fan, or one of too
/// many.
bool set_inner_fan(const GrowState& s, int u, int v, const Vec3d& x, Fan& fan);

/// Whether doubles show for certain that the inner triangles around u meet each other in their
/// common corners and edges only, with no two of them folded onto each other.
bool inner_fan_surely_embedded(const GrowState& s, int u);

/// Would no inner triangle around v meet one that shares a corner with it, with b_v = x? Exact.
/// Reads nothing of vertices further than two edges from v.
bool adjacent_clear_at(const GrowState& s, int v, const Vec3d& x);

} // namespace vdb_shell::growth
