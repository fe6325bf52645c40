// SPDX-License-Identifier: Apache-2.0

// Closest points of pairs of triangles, eight pairs at a time. Takes: pairs, and how wide a slab
// between them need be. Gives: for each about the widest slab between its triangles, across the way
// between their closest points. Floats find out which edges come closest and which pairs are far
// enough apart to need no plane; doubles compute the slab, whose normal is rounded to the floats
// that the plane will have. Which slab is found decides only how thick the shell gets
// (docs/theory.md, "Which planes"); that the triangles are on its two sides is measured along that
// very normal.

#include "growth/separation.h"

#include "growth/separation_lanes.h"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace vdb_shell::growth
{
namespace
{

void set(PointRow& row, std::size_t lane, const Vec3d& p)
{
    for (std::size_t k = 0; k < 3; ++k)
        row.at[k][lane] = p[int(k)];
}
Vec3d get(const PointRow& row, std::size_t lane)
{
    return {row.at[0][lane], row.at[1][lane], row.at[2][lane]};
}

Slab slab_in(const SlabLanes& slabs, std::size_t lane)
{
    return {{slabs.n[0][lane], slabs.n[1][lane], slabs.n[2][lane]},
            slabs.lo[lane],
            slabs.hi[lane],
            slabs.gap[lane]};
}

/// Other directions that keep the triangles of a pair apart: a corner of one may be next to the
/// inside of the other, across whose own plane they are then. Of these the widest that floats have
/// seen; false where it is no wider than `gap`.
bool other_way(const PairLanes& lanes, const PairEstimates& estimates, std::size_t lane, double gap,
               Vec3d& way)
{
    const auto first = static_cast<double>(estimates.across_first[lane]),
               second = static_cast<double>(estimates.across_second[lane]),
               middles = static_cast<double>(estimates.across_middles[lane]);
    const double widest = std::max({first, second, middles});
    if (gap >= widest)
        return false;
    const auto corner = [&](std::size_t i) { return get(lanes.corner[i], lane); };
    way = widest == first    ? corner(1).cross(corner(2))
          : widest == second ? (corner(4) - corner(3)).cross(corner(5) - corner(3))
                             : corner(3) + corner(4) + corner(5) - corner(1) - corner(2);
    return true;
}

void lay_out(const SlabQuery* query, std::size_t count, PairLanes& lanes)
{
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
        // The last one fills the lanes that are left. Relative to a corner of the pair the
        // coordinates keep their digits in floats, however far the pair is from the origin.
        const SlabQuery& pair = query[std::min(lane, count - 1)];
        const Vec3d& origin = (*pair.first)[0];
        for (std::size_t k = 0; k < 3; ++k) {
            set(lanes.corner[k], lane, (*pair.first)[k] - origin);
            set(lanes.corner[3 + k], lane, (*pair.second)[k] - origin);
        }
        lanes.enough[lane] = static_cast<float>(pair.enough);
    }
}

/// The closest of all pairs of edges, for lanes whose edges are too close for floats to choose.
/// Nine times the work, for few lanes. The first of equal ones is taken, as in the floats.
void between_all_edges(const PairLanes& lanes, unsigned which, PointRow& between)
{
    std::array<double, kLanes> least;
    least.fill(std::numeric_limits<double>::max());
    PointRow here;
    for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t j = 0; j < 3; ++j) {
            between_edges({lanes.corner[i], lanes.corner[(i + 1) % 3], lanes.corner[3 + j],
                           lanes.corner[3 + (j + 1) % 3]},
                          here);
            for (unsigned bits = which; bits != 0; bits &= bits - 1) {
                const auto lane = static_cast<std::size_t>(__builtin_ctz(bits));
                const double squared = get(here, lane).lengthSqr();
                if (squared < least[lane])
                    set(between, lane, get(here, lane)), least[lane] = squared;
            }
        }
}

/// From the closest point of the first triangle's edges to that of the second's.
void between_closest_edges(const PairLanes& lanes, const PairEstimates& estimates,
                           PointRow& between)
{
    PointRow p, p_end, q, q_end;
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
        const auto which = static_cast<std::size_t>(estimates.edges[lane]);
        const std::size_t i = which / 3, j = which % 3;
        set(p, lane, get(lanes.corner[i], lane));
        set(p_end, lane, get(lanes.corner[(i + 1) % 3], lane));
        set(q, lane, get(lanes.corner[3 + j], lane));
        set(q_end, lane, get(lanes.corner[3 + (j + 1) % 3], lane));
    }
    between_edges({p, p_end, q, q_end}, between);
    if (const unsigned close = estimates.close & ~estimates.wide)
        between_all_edges(lanes, close, between);
}

} // namespace

void slabs_between(const SlabQuery* query, std::size_t count, Slab* slab)
{
    assert(count <= kLanes);
    if (count == 0)
        return;
    PairLanes lanes;
    lay_out(query, count, lanes);
    PairEstimates estimates;
    estimate_rooms(lanes, estimates);
    PointRow ways;
    between_closest_edges(lanes, estimates, ways);
    SlabLanes across, other;
    slabs_across(lanes, ways, across);
    unsigned doubtful = 0;
    for (std::size_t i = 0; i < count; ++i) {
        // No slab is wider than two points of its triangles are apart. So a slab as wide as the
        // closest points of the edges are apart is the widest, and other directions need not be
        // tried. Most pairs end here.
        constexpr double kAll = 1 - 1e-6;
        const double gap = across.gap[i];
        Vec3d way;
        if ((estimates.wide >> i & 1U) != 0U ||
            (gap > 0 && gap * gap > kAll * kAll * across.squared[i]) ||
            !other_way(lanes, estimates, i, gap, way))
            continue;
        set(ways, i, way);
        doubtful |= 1U << i;
    }
    if (doubtful != 0)
        slabs_across(lanes, ways, other);
    for (std::size_t i = 0; i < count; ++i) {
        const bool rather = (doubtful >> i & 1U) != 0U && other.gap[i] > across.gap[i];
        slab[i] = slab_in(rather ? other : across, i);
        if ((estimates.wide >> i & 1U) != 0U)
            slab[i].gap = std::numeric_limits<double>::infinity();
    }
}

} // namespace vdb_shell::growth
