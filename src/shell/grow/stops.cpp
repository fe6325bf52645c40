// SPDX-License-Identifier: Apache-2.0
#include "shell/grow/stops.h"

#include "core/parallel.h"
#include "shell/grow/move_tests.h"

#include <algorithm>
#include <cmath>

namespace vdb_shell::growth
{
namespace
{

constexpr double kProbe = 1e-3; ///< share of the diagonal
constexpr double kAtCap =
    1e-6; ///< relative; the rounding of the coordinates stops short of the cap

bool beside_a_pin(const GrowState& s, int v)
{
    const Slice<int> around = neighbours(*s.mesh, v);
    return std::any_of(around.begin(), around.end(), [&](int u) { return s.pinned[u] != 0; });
}

/// What the triangles around v meet first, with b_v = x.
StopReason contact_at(const GrowState& s, int v, const Vec3d& x)
{
    const Slice<FaceCorner> fan = star(*s.mesh, v);
    // At a pin kin are outer triangles too.
    const bool kin_apart = !beside_a_pin(s, v);
    if (kin_apart && !kin_clear_at(s, v, x))
        return StopReason::inner_contact;
    for (const FaceCorner& at : fan) {
        const InnerTriangle moved(s, at, x);
        const Box box = box_of(moved.corners());
        bool inner = false, outer = false;
        for (const FaceCorner& other : fan)
            inner = inner || (!kin_apart && other.face > at.face &&
                              moved.meets_inner(other.face, moved_corners(s, other, x)));
        s.inner_tree.for_each_overlap(box, [&](int g) {
            const bool asked = kin_apart ? s.mesh->share_a_corner(at.face, g)
                                         : s.mesh->incident_to(g, v);
            inner = inner || (!asked && moved.meets_inner(g));
        });
        if (inner)
            return StopReason::inner_contact;
        s.outer_tree.for_each_overlap(box, [&](int g) { outer = outer || moved.meets_outer(g); });
        if (outer)
            return StopReason::outer_contact;
    }
    return StopReason::none;
}

StopReason reason_at(const GrowState& s, int v, double step)
{
    if (s.pinned[v])
        return StopReason::pinned;
    const Vec3d arm = s.b[v] - s.a[v];
    const double length = arm.length(), room = s.cap[v] - length;
    if (std::isfinite(room) && room <= kAtCap * s.cap[v] + s.rounding)
        return StopReason::thickness;
    const Vec3d x = rounded(s.b[v] + arm * (std::min(step, room) / length));
    if (!tets_positive_at(s, v, x))
        return StopReason::prism;
    return contact_at(s, v, x);
}

} // namespace

std::vector<StopReason> probe_stops(GrowState& s)
{
    const double step = kProbe * s.diagonal;
    std::vector<Box> boxes(s.mesh->faces.size());
    for_each_index(boxes.size(), [&](std::size_t f) {
        boxes[f] = box_of(inner_corners(s, static_cast<int>(f)));
    });
    s.inner_tree.build(boxes);
    std::vector<StopReason> stop(s.b.size());
    for_each_index(stop.size(),
                   [&](std::size_t v) { stop[v] = reason_at(s, static_cast<int>(v), step); });
    return stop;
}

} // namespace vdb_shell::growth
