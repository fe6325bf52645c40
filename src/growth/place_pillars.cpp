// SPDX-License-Identifier: Apache-2.0

// Takes: directions and lengths. Leaves: inner points where they say, rounded to float32 and within
// the cap, and the vertices pinned that can have no pillar. Nothing is tested: that the prisms hold
// is seen to by whoever calls this (violations.h).

#include "growth/place_pillars.h"

#include "core/parallel.h"
#include "growth/move_tests.h"

namespace vdb_shell::growth
{

void pin_unservable(GrowState& s, const Directions& directions, const std::vector<double>& length)
{
    for (int v = 0; v < s.mesh->vertices; ++v) {
        const bool stranded = star(*s.mesh, v).size() == 0;
        s.pinned[v] = stranded || directions.visibility[v] <= 0 || length[v] <= 0 || s.cap[v] <= 0;
        s.trust_radius[v] = 0;
    }
}

void place_pillars(GrowState& s, const Directions& directions, const std::vector<double>& length)
{
    for_each_index(s.b.size(), [&](std::size_t i) {
        const int v = static_cast<int>(i);
        if (!s.pinned[v])
            s.b[v] = end_within_cap(s, v, directions.inward[v], length[v]);
        // Rounded to float32 a very short pillar may have no length left.
        if (s.b[v] == s.a[v] || s.pinned[v]) {
            s.b[v] = s.a[v];
            s.pinned[v] = 1;
        }
    });
}

} // namespace vdb_shell::growth
