// SPDX-License-Identifier: Apache-2.0

// Takes: where vertices are and how far they went. Leaves: a trust radius for each, on which the
// separating planes of the next round rest: a pair of triangles farther apart than the radii of
// their corners needs no plane, so short radii keep planes few (docs/theory.md, "Separating
// planes"). Trust regions: Nocedal and Wright 2006, "Numerical Optimization", chapter 4; here they
// bound the moves, and the step itself is that of the barrier method.

#include "growth/trust_radius.h"

#include "core/parallel.h"

#include <algorithm>

namespace vdb_shell::growth
{
namespace
{

/// Short ones by the shortest inner edge too: where the inner surface has collapsed already planes
/// would be many, and in a solid that is nearly full it has in one direction at least.
double first_radius(const GrowState& s, int v, bool short_ones)
{
    const TrustRadiusSchedule& schedule = s.schedule.radius;
    const double most_edges = schedule.short_first_inner_edges;
    double outer = 0, longest = 0, shortest = most_edges * s.diagonal;
    for (const int u : neighbours(*s.mesh, v)) {
        const double inner = (s.b[u] - s.b[v]).length();
        outer += (s.a[u] - s.a[v]).length();
        longest = std::max(longest, inner);
        shortest = std::min(shortest, inner);
    }
    const int count = std::max(1, neighbours(*s.mesh, v).size());
    const double inner = short_ones ? std::min(longest, most_edges * shortest) : longest;
    const double share = short_ones ? schedule.short_first_share : 1.0;
    return std::max(share * std::min(schedule.first_edge_share * outer / count, inner),
                    kLeastRadiusInRoundings * s.rounding);
}

} // namespace

void set_first_radii(GrowState& s, bool short_ones)
{
    for_each_index(s.trust_radius.size(), [&](std::size_t v) {
        s.trust_radius[v] = first_radius(s, static_cast<int>(v), short_ones);
    });
}

void adapt_radii(GrowState& s, const std::vector<std::uint8_t>& inactive)
{
    const TrustRadiusSchedule& schedule = s.schedule.radius;
    const double least =
        std::max(schedule.shortest * s.diagonal, kLeastRadiusInRoundings * s.rounding);
    for_each_index(s.trust_radius.size(), [&](std::size_t v) {
        if (inactive[v])
            return;
        // A vertex that came to rest keeps a share of its radius, so that it can start again.
        const double ahead = schedule.factor_on_move * (s.b[v] - s.trust_centre[v]).length();
        s.trust_radius[v] = std::max({least, schedule.kept_share * s.trust_radius[v],
                                      std::min(ahead, schedule.longest * s.diagonal)});
    });
}

Vec3d within_trust_radius(const GrowState& s, int v, const Vec3d& x)
{
    const Vec3d off = x - s.trust_centre[v];
    const double distance = off.length(), most = (1 - kRadiusMargin) * s.trust_radius[v];
    return distance > most ? s.trust_centre[v] + off * (most / distance) : x;
}

double mean_edge(const Connectivity& mesh, const std::vector<Vec3d>& points, int v)
{
    double sum = 0;
    for (const int u : neighbours(mesh, v))
        sum += (points[u] - points[v]).length();
    return sum / std::max(1, neighbours(mesh, v).size());
}

} // namespace vdb_shell::growth
