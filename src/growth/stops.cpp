// SPDX-License-Identifier: Apache-2.0

// Takes: the finished shell. Gives: for each vertex what would fail first if its pillar were a
// little longer, by the same exact tests that held it, so that the report can say why a shell is no
// thicker. Changes nothing but the boxes of the inner tree.

#include "growth/stops.h"

#include "core/parallel.h"
#include "growth/active_set.h"
#include "growth/first_contact.h"
#include "growth/move_tests.h"

#include <algorithm>
#include <cmath>

namespace vdb_shell::growth
{
namespace
{

/// What b_v itself goes through on its way to x: most that are held up are held up by that, and it
/// is found sooner than what the triangles around it meet.
StopReason met_on_way(const GrowState& s, int v, const Vec3d& x)
{
    const FloatBox box = float_box(box_of({s.b[v], x, x}));
    bool met = false;
    s.inner_tree.for_each_overlap_while(box, [&](int g) {
        met =
            !s.mesh->incident_to(g, v) && segment_touches_triangle(s.b[v], x, inner_corners(s, g));
        return !met;
    });
    if (met)
        return StopReason::inner_contact;
    s.outer_tree.for_each_overlap_while(box, [&](int g) {
        met = segment_touches_triangle(s.b[v], x, outer_corners(s, g));
        return !met;
    });
    return met ? StopReason::outer_contact : StopReason::none;
}

StopReason plain_reason(const GrowState& s, int v)
{
    if (s.pinned[v])
        return StopReason::pinned;
    const double room = s.cap[v] - (s.b[v] - s.a[v]).length();
    return std::isfinite(room) && room <= s.schedule.stops.at_cap * s.cap[v] + s.rounding
               ? StopReason::thickness
               : StopReason::not_asked;
}

/// What a step meets. Precondition: no plain reason, for a vertex at its cap has no room for a step
/// that could meet anything. `in_crowd`: one of thousands around a vertex, each of which would ask
/// about all of its triangles.
StopReason reason_of_step(const GrowState& s, int v, double step, bool in_crowd,
                          NearTriangles& near)
{
    const Vec3d arm = s.b[v] - s.a[v];
    const double length = arm.length(), room = s.cap[v] - length;
    const Vec3d x = rounded(s.b[v] + arm * (std::min(step, room) / length));
    if (!tets_positive_at(s, v, x))
        return StopReason::prism;
    const StopReason met = met_on_way(s, v, x);
    return met == StopReason::none && !in_crowd ? first_contact(s, v, x, near) : met;
}

} // namespace

std::vector<StopReason> probe_stops(GrowState& s)
{
    const double step = s.schedule.stops.step * s.diagonal;
    refit_inner_tree(s);
    std::vector<StopReason> stop = plain_stops(s);
    std::vector<std::uint8_t> in_crowd(s.b.size());
    leave_out_crowds(s, in_crowd);
    for_each_range(stop.size(), [&](std::size_t begin, std::size_t end) {
        NearTriangles near;
        for (std::size_t v = begin; v < end; ++v)
            if (stop[v] == StopReason::not_asked)
                stop[v] = reason_of_step(s, static_cast<int>(v), step, in_crowd[v] != 0, near);
    });
    return stop;
}

std::vector<StopReason> plain_stops(const GrowState& s)
{
    std::vector<StopReason> stop(s.b.size());
    for_each_index(stop.size(),
                   [&](std::size_t v) { stop[v] = plain_reason(s, static_cast<int>(v)); });
    return stop;
}

} // namespace vdb_shell::growth
