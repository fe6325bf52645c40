// SPDX-License-Identifier: Apache-2.0
#include "shell/grow/stops.h"

#include "core/parallel.h"
#include "shell/grow/candidates.h"
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
    int blocker = 0;
    if (star_clear_at(s, v, x, &blocker))
        return StopReason::none;
    return blocker < s.mesh->face_count() ? StopReason::inner_contact : StopReason::outer_contact;
}

} // namespace

std::vector<StopReason> probe_stops(GrowState& s)
{
    const double step = kProbe * s.diagonal;
    s.reach.assign(s.b.size(), 1.01 * step + s.rounding);
    rebuild_candidates(s);
    std::vector<StopReason> stop(s.b.size());
    for_each_index(stop.size(),
                   [&](std::size_t v) { stop[v] = reason_at(s, static_cast<int>(v), step); });
    return stop;
}

} // namespace vdb_shell::growth
