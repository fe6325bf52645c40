// SPDX-License-Identifier: Apache-2.0

// Closest points of pairs of triangles, eight pairs at a time. Floats find out which edges come
// closest and which pairs are far enough apart to need no plane; doubles compute the slab. Which
// slab is found decides only how thick the shell gets (docs/theory.md, "Which planes").

#include "growth/separation.h"

#include "core/four_floats.h"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace vdb_shell::growth
{
namespace
{

/// A point or a direction to a lane, by axis.
struct alignas(kLanesAlignment) PointRow {
    std::array<std::array<double, kLanes>, 3> at;
    void set(std::size_t lane, const Vec3d& p)
    {
        at[0][lane] = p[0], at[1][lane] = p[1], at[2][lane] = p[2];
    }
    Vec3d get(std::size_t lane) const { return {at[0][lane], at[1][lane], at[2][lane]}; }
};

/// The corners of the pairs, a pair to a lane: those of the first triangles, then of the second,
/// relative to corner 0 of the first.
struct PairLanes {
    std::array<PointRow, 6> corner;
    alignas(kLanesAlignment) std::array<float, kLanes> enough;
};

/// What floats tell of each pair. Rooms are in units of its size, the largest coordinate.
struct FloatRooms {
    unsigned wide = 0;  ///< a bit a lane: certainly wider than enough
    unsigned close = 0; ///< edges so close that floats cannot choose
    std::array<float, kLanes>
        edges; ///< 3 i + j for the closest, i of the first and j of the second
    std::array<float, kLanes> across_middles, across_first, across_second;
};

using LanePoint = std::array<Lanes, 3>;

// Squares of it are far from underflow, which would cost more than all the rest.
constexpr float kTiny = 1e-12F;
// In units of a pair's size. Below the first, edges are too close for floats; the second is far
// above the error of a room.
constexpr float kClose = 0.004F, kErrorOfRoom = 1e-5F;
// Of the squared sine between two edges: below it only their ends are looked at.
constexpr float kParallel = 1e-3F;

VDB_SHELL_LANES_PART void dot(const LanePoint& a, const LanePoint& b, Lanes& out)
{
    out = a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

VDB_SHELL_LANES_PART void cross(const LanePoint& a, const LanePoint& b, LanePoint& out)
{
    out[0] = a[1] * b[2] - a[2] * b[1];
    out[1] = a[2] * b[0] - a[0] * b[2];
    out[2] = a[0] * b[1] - a[1] * b[0];
}

VDB_SHELL_LANES_PART void difference(const LanePoint& a, const LanePoint& b, LanePoint& out)
{
    for (std::size_t k = 0; k < 3; ++k)
        out[k] = a[k] - b[k];
}

/// The corners as in PairLanes; the first is the origin.
using PairCorners = std::array<LanePoint, 6>;

/// The room across an axis of any length, in units of the pair.
VDB_SHELL_LANES_PART void room_across(const LanePoint& axis, const PairCorners& c, Lanes& out)
{
    std::array<Lanes, 5> d;
    for (std::size_t i = 0; i < 5; ++i)
        dot(axis, c[1 + i], d[i]);
    Lanes s_low{}, s_high{}, t_low = d[2], t_high = d[2], squared;
    for (std::size_t i = 0; i < 2; ++i) {
        lower_to(s_low, d[i]), raise_to(s_high, d[i]);
        lower_to(t_low, d[3 + i]), raise_to(t_high, d[3 + i]);
    }
    out = s_low - t_high;
    raise_to(out, t_low - s_high);
    dot(axis, axis, squared);
    for (std::size_t i = 0; i < kLanes; ++i)
        out[i] /= std::sqrt(squared[i]) + kTiny;
}

VDB_SHELL_LANES_PART void clamp_to_one(Lanes& x)
{
    raise_to(x, Lanes{});
    lower_to(x, Lanes{1, 1, 1, 1, 1, 1, 1, 1});
}

/// Two edges p + [0, 1] d and q + [0, 1] e, with r = p - q.
struct EdgeLanes {
    const LanePoint &d, &e, &r;
    const Lanes &dd_inverse, &ee_inverse;
    Lanes de, dr, er;
};

/// Lowers `least` to the squared distance from the point of q's edge that is nearest to
/// p + start d.
VDB_SHELL_LANES_PART void lower_to_distance2(const EdgeLanes& edges, const Lanes& start,
                                             Lanes& least)
{
    Lanes t = (edges.de * start + edges.er) * edges.ee_inverse;
    clamp_to_one(t);
    Lanes s = (edges.de * t - edges.dr) * edges.dd_inverse;
    clamp_to_one(s);
    LanePoint between;
    for (std::size_t k = 0; k < 3; ++k)
        between[k] = edges.r[k] + s * edges.d[k] - t * edges.e[k];
    Lanes squared;
    dot(between, between, squared);
    lower_to(least, squared);
}

/// Which edges come closest, and how close.
VDB_SHELL_LANES_PART void closest_edges(const PairCorners& c, Lanes& least, Lanes& which)
{
    const LanePoint *const p = &c[0], *const q = &c[3];
    const Lanes none{}, one = none + 1;
    std::array<LanePoint, 3> d, e;
    std::array<Lanes, 3> dd, ee, dd_inverse, ee_inverse;
    for (std::size_t i = 0; i < 3; ++i) {
        difference(p[(i + 1) % 3], p[i], d[i]);
        difference(q[(i + 1) % 3], q[i], e[i]);
        dot(d[i], d[i], dd[i]), dot(e[i], e[i], ee[i]);
        dd[i] += kTiny, ee[i] += kTiny;
        dd_inverse[i] = 1 / dd[i], ee_inverse[i] = 1 / ee[i];
    }
    least = none + std::numeric_limits<float>::max();
    which = none;
    for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t j = 0; j < 3; ++j) {
            LanePoint r;
            difference(p[i], q[j], r);
            EdgeLanes edges{d[i], e[j], r, dd_inverse[i], ee_inverse[j], {}, {}, {}};
            dot(d[i], e[j], edges.de), dot(d[i], r, edges.dr), dot(e[j], r, edges.er);
            const Lanes most = dd[i] * ee[j];
            Lanes denominator = most - edges.de * edges.de;
            const unsigned parallel = bits_of(denominator < kParallel * most);
            raise_to(denominator, kParallel * most);
            Lanes start = (edges.de * edges.er - edges.dr * ee[j]) / denominator;
            clamp_to_one(start);
            Lanes squared = none + std::numeric_limits<float>::max();
            lower_to_distance2(edges, start, squared);
            if (parallel != 0) {
                // One of the ends is among the closest points.
                lower_to_distance2(edges, none, squared);
                lower_to_distance2(edges, one, squared);
            }
            const auto index = static_cast<float>(3 * i + j);
            which = squared < least ? none + index : which;
            lower_to(least, squared);
        }
}

VDB_SHELL_TWO_TARGETS void look_at(const PairLanes& pairs, FloatRooms& rooms)
{
    // Not copied from here on: of copies GCC makes halves, which the processor waits for.
    PairCorners c;
    for (Lanes& x : c[0])
        x = Lanes{};
    Lanes size{};
    for (std::size_t i = 1; i < 6; ++i)
        for (std::size_t k = 0; k < 3; ++k) {
            std::array<FourFloats, 2> half;
            for (std::size_t h = 0; h < 2; ++h) {
                DoubleLanes wide;
                load_lanes(pairs.corner[i].at[k].data() + h * kDoubleLanes, wide);
                half[h] = __builtin_convertvector(wide, FourFloats);
            }
            c[i][k] = __builtin_shufflevector(half[0], half[1], 0, 1, 2, 3, 4, 5, 6, 7);
            raise_to(size, c[i][k]);
            raise_to(size, -c[i][k]);
        }
    const Lanes inverse = 1 / (size + std::numeric_limits<float>::min());
    for (LanePoint& point : c)
        for (Lanes& x : point)
            x *= inverse;
    Lanes enough;
    load_lanes(pairs.enough.data(), enough);
    enough = enough * inverse + kErrorOfRoom;

    LanePoint u, w, normal, middles;
    for (std::size_t k = 0; k < 3; ++k)
        middles[k] = c[3][k] + c[4][k] + c[5][k] - c[1][k] - c[2][k];
    Lanes across_middles, across_first, across_second;
    room_across(middles, c, across_middles);
    cross(c[1], c[2], normal);
    room_across(normal, c, across_first);
    difference(c[4], c[3], u), difference(c[5], c[3], w);
    cross(u, w, normal);
    room_across(normal, c, across_second);
    Lanes widest = across_middles;
    raise_to(widest, across_first);
    raise_to(widest, across_second);
    rooms.wide = bits_of(widest > enough);

    Lanes squared, edges;
    closest_edges(c, squared, edges);
    rooms.close = bits_of(squared < kClose * kClose);
    store_lanes(edges, rooms.edges.data());
    across_middles *= size, across_first *= size, across_second *= size;
    store_lanes(across_middles, rooms.across_middles.data());
    store_lanes(across_first, rooms.across_first.data());
    store_lanes(across_second, rooms.across_second.data());
}

VDB_SHELL_LANES_PART void load(const PointRow& row, std::size_t first, DoublePoint& out)
{
    for (std::size_t k = 0; k < 3; ++k)
        load_lanes(row.at[k].data() + first, out[k]);
}

VDB_SHELL_LANES_PART void dot(const DoublePoint& a, const DoublePoint& b, DoubleLanes& out)
{
    out = a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

VDB_SHELL_LANES_PART void clamp_to_one(DoubleLanes& x)
{
    x = x < 0.0 ? DoubleLanes{} : x;
    x = x > 1.0 ? DoubleLanes{} + 1.0 : x;
}

/// Edges from p and from q to their ends.
struct EdgeRows {
    const PointRow &p, &p_end, &q, &q_end;
};

/// From the closest point of each first edge to that of the second (Ericson 2005, "Real-Time
/// Collision Detection", 5.1.9).
VDB_SHELL_TWO_TARGETS void between_edges(const EdgeRows& edges, PointRow& between)
{
    constexpr double kParallelInDoubles = 1e-12;
    for (std::size_t first = 0; first < kLanes; first += kDoubleLanes) {
        DoublePoint p, d, q, e, r;
        load(edges.p, first, p), load(edges.p_end, first, d);
        load(edges.q, first, q), load(edges.q_end, first, e);
        for (std::size_t k = 0; k < 3; ++k)
            d[k] -= p[k], e[k] -= q[k], r[k] = p[k] - q[k];
        DoubleLanes dd, ee, de, dr, er;
        dot(d, d, dd), dot(e, e, ee), dot(d, e, de), dot(d, r, dr), dot(e, r, er);
        const DoubleLanes denominator = dd * ee - de * de;
        const auto crossed = denominator > kParallelInDoubles * dd * ee;
        const auto from = [&](const DoubleLanes& start, DoublePoint& way, DoubleLanes& squared) {
            DoubleLanes t = (de * start + er) / ee;
            t = ee > 0.0 ? t : DoubleLanes{};
            clamp_to_one(t);
            DoubleLanes s = (de * t - dr) / dd;
            s = dd > 0.0 ? s : DoubleLanes{};
            clamp_to_one(s);
            for (std::size_t k = 0; k < 3; ++k)
                way[k] = (q[k] + t * e[k]) - (p[k] + s * d[k]);
            dot(way, way, squared);
        };
        DoubleLanes start = (de * er - dr * ee) / denominator;
        start = crossed ? start : DoubleLanes{};
        clamp_to_one(start);
        DoublePoint way, other;
        DoubleLanes squared, other_squared;
        from(start, way, squared);
        from(DoubleLanes{} + 1.0, other, other_squared);
        // Of parallel edges one of the ends is among the closest points.
        const auto good = crossed | (squared < other_squared);
        for (std::size_t k = 0; k < 3; ++k) {
            const DoubleLanes chosen = good ? way[k] : other[k];
            store_lanes(chosen, between.at[k].data() + first);
        }
    }
}

/// The slabs of the pairs across a direction each, and that one's length, squared.
struct SlabLanes {
    alignas(kLanesAlignment) std::array<std::array<float, kLanes>, 3> n;
    alignas(kLanesAlignment) std::array<double, kLanes> lo, hi, gap, squared;
};

VDB_SHELL_TWO_TARGETS void slabs_across(const PairLanes& pairs, const PointRow& ways,
                                        SlabLanes& slabs)
{
    for (std::size_t first = 0; first < kLanes; first += kDoubleLanes) {
        DoublePoint way, m;
        load(ways, first, way);
        DoubleLanes squared, length;
        dot(way, way, squared);
        for (std::size_t i = 0; i < kDoubleLanes; ++i)
            length[i] = std::sqrt(squared[i]);
        std::array<FourFloats, 3> n;
        for (std::size_t k = 0; k < 3; ++k) {
            // The plane is made of this rounded normal, so its slab has to be measured with it.
            n[k] = __builtin_convertvector(way[k] / length, FourFloats);
            m[k] = __builtin_convertvector(n[k], DoubleLanes);
        }
        std::array<DoubleLanes, 5> at;
        for (std::size_t i = 0; i < 5; ++i) {
            DoublePoint corner;
            load(pairs.corner[1 + i], first, corner);
            dot(m, corner, at[i]);
        }
        DoubleLanes s_lo{}, s_hi{}, t_lo = at[2], t_hi = at[2];
        for (std::size_t i = 0; i < 2; ++i) {
            s_lo = at[i] < s_lo ? at[i] : s_lo, s_hi = at[i] > s_hi ? at[i] : s_hi;
            t_lo = at[3 + i] < t_lo ? at[3 + i] : t_lo, t_hi = at[3 + i] > t_hi ? at[3 + i] : t_hi;
        }
        const DoubleLanes along = s_lo - t_hi, against = t_lo - s_hi;
        const auto plain = along > against;
        const DoubleLanes lo = plain ? s_lo : -s_hi, hi = plain ? t_hi : -t_lo;
        DoubleLanes gap = plain ? along : against;
        gap = length > 0.0 ? gap : DoubleLanes{} - std::numeric_limits<double>::max();
        for (std::size_t k = 0; k < 3; ++k)
            for (std::size_t i = 0; i < kDoubleLanes; ++i)
                slabs.n[k][first + i] = plain[i] ? n[k][i] : -n[k][i];
        store_lanes(lo, slabs.lo.data() + first);
        store_lanes(hi, slabs.hi.data() + first);
        store_lanes(gap, slabs.gap.data() + first);
        store_lanes(squared, slabs.squared.data() + first);
    }
}

Slab slab_in(const SlabLanes& slabs, std::size_t lane)
{
    return {{slabs.n[0][lane], slabs.n[1][lane], slabs.n[2][lane]},
            slabs.lo[lane],
            slabs.hi[lane],
            slabs.gap[lane]};
}

/// Other directions that keep the triangles of a pair apart: a corner of one may be next to the
/// inside of the other, across whose own plane they are then. Of these the widest that floats
/// have found; false where it is no wider than `gap`.
bool other_way(const PairLanes& lanes, const FloatRooms& rooms, std::size_t lane, double gap,
               Vec3d& way)
{
    const auto first = static_cast<double>(rooms.across_first[lane]),
               second = static_cast<double>(rooms.across_second[lane]),
               middles = static_cast<double>(rooms.across_middles[lane]);
    const double widest = std::max({first, second, middles});
    if (gap >= widest)
        return false;
    const auto corner = [&](std::size_t i) { return lanes.corner[i].get(lane); };
    way = widest == first    ? corner(1).cross(corner(2))
          : widest == second ? (corner(4) - corner(3)).cross(corner(5) - corner(3))
                             : corner(3) + corner(4) + corner(5) - corner(1) - corner(2);
    return true;
}

void lay_out(const SlabQuery* query, std::size_t count, PairLanes& lanes)
{
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
        // The last one fills the lanes that are left.
        const SlabQuery& pair = query[std::min(lane, count - 1)];
        const Vec3d& origin = (*pair.first)[0];
        for (std::size_t k = 0; k < 3; ++k) {
            lanes.corner[k].set(lane, (*pair.first)[k] - origin);
            lanes.corner[3 + k].set(lane, (*pair.second)[k] - origin);
        }
        lanes.enough[lane] = static_cast<float>(pair.enough);
    }
}

/// The closest of all pairs of edges, for lanes whose edges are too close for floats to choose.
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
                const double squared = here.get(lane).lengthSqr();
                if (squared < least[lane])
                    between.set(lane, here.get(lane)), least[lane] = squared;
            }
        }
}

/// From the closest point of the first triangle's edges to that of the second's.
void between_closest_edges(const PairLanes& lanes, const FloatRooms& rooms, PointRow& between)
{
    PointRow p, p_end, q, q_end;
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
        const auto which = static_cast<std::size_t>(rooms.edges[lane]);
        const std::size_t i = which / 3, j = which % 3;
        p.set(lane, lanes.corner[i].get(lane));
        p_end.set(lane, lanes.corner[(i + 1) % 3].get(lane));
        q.set(lane, lanes.corner[3 + j].get(lane));
        q_end.set(lane, lanes.corner[3 + (j + 1) % 3].get(lane));
    }
    between_edges({p, p_end, q, q_end}, between);
    if (const unsigned close = rooms.close & ~rooms.wide)
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
    FloatRooms rooms;
    look_at(lanes, rooms);
    PointRow ways;
    between_closest_edges(lanes, rooms, ways);
    SlabLanes across, other;
    slabs_across(lanes, ways, across);
    unsigned doubtful = 0;
    for (std::size_t i = 0; i < count; ++i) {
        // No slab is wider than two points are apart: most pairs end here.
        constexpr double kAll = 1 - 1e-6;
        const double gap = across.gap[i];
        Vec3d way;
        if ((rooms.wide >> i & 1U) != 0U ||
            (gap > 0 && gap * gap > kAll * kAll * across.squared[i]) ||
            !other_way(lanes, rooms, i, gap, way))
            continue;
        ways.set(i, way);
        doubtful |= 1U << i;
    }
    if (doubtful != 0)
        slabs_across(lanes, ways, other);
    for (std::size_t i = 0; i < count; ++i) {
        const bool rather = (doubtful >> i & 1U) != 0U && other.gap[i] > across.gap[i];
        slab[i] = slab_in(rather ? other : across, i);
        if ((rooms.wide >> i & 1U) != 0U)
            slab[i].gap = std::numeric_limits<double>::infinity();
    }
}

} // namespace vdb_shell::growth
