// SPDX-License-Identifier: Apache-2.0

// Takes: a valid state and a place for one inner point. Gives: which kind of contact the triangles
// around it would have there, by the exact tests. Cheap tests come first: what shares a corner is
// told apart by fans, and the rest is asked for once for all triangles around the vertex.

#include "growth/first_contact.h"

#include "growth/move_tests.h"

namespace vdb_shell::growth
{

StopReason first_contact(const GrowState& s, int v, const Vec3d& x, NearTriangles& near)
{
    const Slice<FaceCorner> fan = star(*s.mesh, v);
    // Around a pin the inner triangles share corners with outer ones too, and the fans do not tell.
    const bool fans_clear = !beside_a_pin(s, v);
    if (fans_clear && !adjacent_clear_at(s, v, x))
        return StopReason::inner_contact;
    const FloatBox all = float_box(box_of_star(s, v, x));
    s.inner_tree.list_overlaps(all, near.inner);
    s.outer_tree.list_overlaps(all, near.outer);
    for (const FaceCorner& at : fan) {
        const InnerTriangle moved(s, at, x);
        const FloatBox box = float_box_of(moved.corners());
        for (const FaceCorner& other : fan)
            if (!fans_clear && other.face > at.face &&
                moved.meets_inner(other.face, moved_corners(s, other, x)))
                return StopReason::inner_contact;
        const auto tested = [&](int g) {
            return s.mesh->incident_to(g, v) || (fans_clear && s.mesh->share_a_corner(at.face, g));
        };
        if (near.inner.any_overlap(box, [&](int g) { return !tested(g) && moved.meets_inner(g); }))
            return StopReason::inner_contact;
        if (near.outer.any_overlap(box, [&](int g) { return moved.meets_outer(g); }))
            return StopReason::outer_contact;
    }
    return StopReason::none;
}

} // namespace vdb_shell::growth
