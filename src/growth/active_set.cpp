// SPDX-License-Identifier: Apache-2.0

// Takes: what each vertex did in the last round. Gives: the vertices that are likely to win in the
// next. Which they are bears on thickness and time only: a vertex that is left out stays where it
// is, which is valid.

#include "growth/active_set.h"

#include "core/parallel.h"

#include <algorithm>
#include <cmath>

namespace vdb_shell::growth
{

void leave_out_crowds(const GrowState& s, std::vector<std::uint8_t>& inactive)
{
    if (!s.mesh->has_crowds)
        return;
    for (int v = 0; v < s.mesh->vertices; ++v) {
        if (std::size_t(star(*s.mesh, v).size()) <= FanWork::kCrowd)
            continue;
        inactive[v] = 1;
        for (const int u : neighbours(*s.mesh, v))
            inactive[u] = 1;
    }
}

std::vector<std::uint8_t> inactive_vertices(const GrowState& s, const ActiveSet& set)
{
    const ActiveSetSchedule& schedule = s.schedule.active;
    std::vector<std::uint8_t> inactive(s.b.size());
    for (std::size_t v = 0; v < inactive.size(); ++v) {
        // A vertex that has come to rest may be set free by its neighbours, so it is looked in on.
        // Which round it is for a vertex depends on its index, so that not all come back at once.
        const int idle = set.idle_rounds[v];
        inactive[v] =
            s.pinned[v] || (idle > schedule.patience && (idle + int(v)) % schedule.period != 0);
    }
    leave_out_crowds(s, inactive);
    return inactive;
}

void leave_out_satisfied(const GrowState& s, const ActiveSet& set, double least_gain,
                         std::vector<std::uint8_t>& inactive)
{
    for_each_index(inactive.size(), [&](std::size_t i) {
        const Slice<int> around = neighbours(*s.mesh, static_cast<int>(i));
        const auto wins = [&](std::size_t v) { return set.gain[v] > least_gain; };
        // What a vertex wins moves its neighbours' planes, so they may win something after it.
        if (!wins(i) && std::none_of(around.begin(), around.end(),
                                     [&](int u) { return wins(static_cast<std::size_t>(u)); }))
            inactive[i] = 1;
    });
}

void leave_out_spent(const GrowState& s, double least_gain, std::vector<std::uint8_t>& inactive)
{
    // The first sweep of a round takes most of what there is; a second one over the rest pays only
    // where the first won something.
    std::vector<double> gain;
    measure_gain(s, inactive, gain);
    for (std::size_t v = 0; v < inactive.size(); ++v)
        inactive[v] |= !(gain[v] > least_gain);
}

void count_idle_rounds(const GrowState& s, ActiveSet& set)
{
    const ActiveSetSchedule& schedule = s.schedule.active;
    for (int v = 0; v < s.mesh->vertices; ++v) {
        // Relative to the pillar too: what a long pillar wins by a short move is next to nothing.
        const double little = std::max(schedule.resting_move * s.diagonal,
                                       schedule.resting_pillar_share * (s.b[v] - s.a[v]).length());
        const bool idle = (s.b[v] - s.trust_centre[v]).length() < little;
        set.idle_rounds[v] = idle ? set.idle_rounds[v] + 1 : 0;
    }
}

void measure_gain(const GrowState& s, const std::vector<std::uint8_t>& inactive,
                  std::vector<double>& gain)
{
    gain.resize(inactive.size());
    for_each_index(inactive.size(), [&](std::size_t i) {
        const int v = static_cast<int>(i);
        // To first order, which is enough to rank vertices. A loss counts like a gain: the barrier
        // undoes a jam there, and volume comes back when it has.
        const Vec3d move = s.b[v] - s.trust_centre[v];
        gain[i] = inactive[i] ? 0 : std::abs(inner_volume6_gradient(s, v).dot(move));
    });
}

} // namespace vdb_shell::growth
