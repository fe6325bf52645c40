// SPDX-License-Identifier: Apache-2.0

// Takes: pairs of triangles, a pair to a lane, relative to a corner of the first. Gives: in floats
// an estimate of each pair, with an allowance for its error, so that what is called wide enough is;
// in doubles the way between two closest points of edges, and the slab across a way. Two triangles
// that do not touch have their closest points either on an edge of each or at a corner of one over
// the inside of the other; the second case is that of the directions across the triangles. Closest
// points of edges: Ericson 2005, "Real-Time Collision Detection", 5.1.9. Lanes do not depend on
// each other, and the bits are the same on every processor (core/simd.h).

#include "core/simd.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "growth/separation_lanes.cpp"
#include <hwy/foreach_target.h>

#include "core/dispatch.h"
#include "core/simd-inl.h"
#include "growth/separation_lanes.h"

#include <limits>

HWY_BEFORE_NAMESPACE();
namespace vdb_shell::growth
{
namespace HWY_NAMESPACE
{
namespace
{

using namespace simd::HWY_NAMESPACE;

// Squares of it are far from underflow, which would cost more than all the rest.
constexpr float kTiny = 1e-12F;
// In units of a pair's size, the largest coordinate. Below the first, edges are too close for
// floats; the second is far above the error of a room.
constexpr float kClose = 0.004F, kErrorOfRoom = 1e-5F;
// Of the squared sine between two edges: below it only their ends are looked at.
constexpr float kParallel = 1e-3F;

HWY_INLINE FloatPoint difference(const FloatPoint& a, const FloatPoint& b)
{
    return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}

/// The corners as in PairLanes; the first is the origin.
using PairCorners = std::array<FloatPoint, 6>;

/// The room across an axis of any length, in units of the pair; negative where the extents of the
/// triangles overlap. Corner 0 of the first is the origin and has its place at nought.
HWY_INLINE Floats room_across(const FloatPoint& axis, const PairCorners& c)
{
    std::array<Floats, 5> d;
    for (std::size_t i = 0; i < 5; ++i)
        d[i] = dot(axis, c[1 + i]);
    Floats s_low(0.0F), s_high(0.0F), t_low = d[2], t_high = d[2];
    for (std::size_t i = 0; i < 2; ++i) {
        lower_to(s_low, d[i]), raise_to(s_high, d[i]);
        lower_to(t_low, d[3 + i]), raise_to(t_high, d[3 + i]);
    }
    Floats room = s_low - t_high;
    raise_to(room, t_low - s_high);
    return room / (square_root(dot(axis, axis)) + kTiny);
}

template <class Lanes> HWY_INLINE Lanes clamped_to_one(Lanes x)
{
    return clamped(x, Lanes(0), Lanes(1));
}

/// Two edges p + [0, 1] d and q + [0, 1] e, with r = p - q.
struct EdgePair {
    const FloatPoint &d, &e, &r;
    const Floats &dd_inverse, &ee_inverse;
    Floats de, dr, er;
};

/// Lowers `least` to the squared distance from the point of q's edge that is nearest to p + start
/// d. Clamping the one parameter and then finding the other anew gives closest points of the edges,
/// as long as `start` is that of the lines.
HWY_INLINE void lower_to_distance2(const EdgePair& edges, Floats start, Floats& least)
{
    const Floats t = clamped_to_one((edges.de * start + edges.er) * edges.ee_inverse);
    const Floats s = clamped_to_one((edges.de * t - edges.dr) * edges.dd_inverse);
    FloatPoint between;
    for (std::size_t k = 0; k < 3; ++k)
        between[k] = edges.r[k] + s * edges.d[k] - t * edges.e[k];
    lower_to(least, dot(between, between));
}

/// Which edges come closest, and how close.
HWY_INLINE void closest_edges(const PairCorners& c, Floats& least, Floats& which)
{
    const FloatPoint *const p = &c[0], *const q = &c[3];
    const Floats none(0.0F), one(1.0F);
    std::array<FloatPoint, 3> d, e;
    std::array<Floats, 3> dd, ee, dd_inverse, ee_inverse;
    for (std::size_t i = 0; i < 3; ++i) {
        d[i] = difference(p[(i + 1) % 3], p[i]);
        e[i] = difference(q[(i + 1) % 3], q[i]);
        dd[i] = dot(d[i], d[i]) + kTiny, ee[i] = dot(e[i], e[i]) + kTiny;
        dd_inverse[i] = 1.0F / dd[i], ee_inverse[i] = 1.0F / ee[i];
    }
    least = Floats(std::numeric_limits<float>::max());
    which = none;
    for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t j = 0; j < 3; ++j) {
            const FloatPoint r = difference(p[i], q[j]);
            const EdgePair edges{d[i],          e[j],          r,
                                 dd_inverse[i], ee_inverse[j], dot(d[i], e[j]),
                                 dot(d[i], r),  dot(e[j], r)};
            const Floats most = dd[i] * ee[j];
            Floats denominator = most - edges.de * edges.de;
            const unsigned parallel = bits_of(denominator < kParallel * most);
            raise_to(denominator, kParallel * most);
            const Floats start =
                clamped_to_one((edges.de * edges.er - edges.dr * ee[j]) / denominator);
            Floats squared(std::numeric_limits<float>::max());
            lower_to_distance2(edges, start, squared);
            if (parallel != 0) {
                // One of the ends is among the closest points.
                lower_to_distance2(edges, none, squared);
                lower_to_distance2(edges, one, squared);
            }
            // Of equally close pairs the first one stays, on every processor.
            which = select(squared < least, Floats(static_cast<float>(3 * i + j)), which);
            lower_to(least, squared);
        }
}

/// In units of the pairs' sizes: one set of tolerances serves triangles of any scale, and no square
/// overflows. The least float keeps a pair without extent from a division by nought.
HWY_INLINE void scaled_corners(const PairLanes& pairs, PairCorners& c, Floats& size,
                               Floats& inverse)
{
    for (Floats& x : c[0])
        x = Floats(0.0F);
    size = Floats(0.0F);
    for (std::size_t i = 1; i < 6; ++i)
        for (std::size_t k = 0; k < 3; ++k) {
            const double* at = pairs.corner[i].at[k].data();
            c[i][k] =
                Floats(to_floats(Doubles::load(at)), to_floats(Doubles::load(at + kDoubleLanes)));
            raise_to(size, c[i][k]);
            raise_to(size, -c[i][k]);
        }
    inverse = 1.0F / (size + std::numeric_limits<float>::min());
    for (FloatPoint& point : c)
        for (Floats& x : point)
            x *= inverse;
}

void estimate_rooms(const PairLanes& pairs, PairEstimates& estimates)
{
    PairCorners c;
    Floats size, inverse;
    scaled_corners(pairs, c, size, inverse);
    FloatPoint middles;
    for (std::size_t k = 0; k < 3; ++k)
        middles[k] = c[3][k] + c[4][k] + c[5][k] - c[1][k] - c[2][k];
    const Floats across_middles = room_across(middles, c),
                 across_first = room_across(cross(c[1], c[2]), c),
                 across_second =
                     room_across(cross(difference(c[4], c[3]), difference(c[5], c[3])), c);
    Floats widest = across_middles;
    raise_to(widest, across_first);
    raise_to(widest, across_second);
    // The allowance for the error is on the safe side: a pair that is called wide has no plane, and
    // the proof rests on its being wide enough.
    const Floats enough = Floats::load(pairs.enough.data()) * inverse + kErrorOfRoom;
    estimates.wide = bits_of(widest > enough);

    Floats squared, edges;
    closest_edges(c, squared, edges);
    estimates.close = bits_of(squared < kClose * kClose);
    store(edges, estimates.edges.data());
    store(across_middles * size, estimates.across_middles.data());
    store(across_first * size, estimates.across_first.data());
    store(across_second * size, estimates.across_second.data());
}

HWY_INLINE DoublePoint load(const PointRow& row, std::size_t first)
{
    return {Doubles::load(row.at[0].data() + first), Doubles::load(row.at[1].data() + first),
            Doubles::load(row.at[2].data() + first)};
}

/// Two edges p + [0, 1] d and q + [0, 1] e, with products of the two and of p - q.
struct WideEdgePair {
    DoublePoint p, d, q, e;
    Doubles dd, ee, de, dr, er;

    /// The way between the edges from where p + start d is nearest to q's edge.
    HWY_INLINE DoublePoint way_from(Doubles start) const
    {
        const Doubles zero(0.0);
        const Doubles t = clamped_to_one(select(ee > zero, (de * start + er) / ee, zero));
        const Doubles s = clamped_to_one(select(dd > zero, (de * t - dr) / dd, zero));
        DoublePoint way;
        for (std::size_t k = 0; k < 3; ++k)
            way[k] = (q[k] + t * e[k]) - (p[k] + s * d[k]);
        return way;
    }
};

void between_edges(const EdgeRows& edges, PointRow& between)
{
    constexpr double kParallelInDoubles = 1e-12;
    for (std::size_t first = 0; first < kLanes; first += kDoubleLanes) {
        WideEdgePair pair;
        pair.p = load(edges.p, first), pair.d = load(edges.p_end, first);
        pair.q = load(edges.q, first), pair.e = load(edges.q_end, first);
        DoublePoint r;
        for (std::size_t k = 0; k < 3; ++k)
            pair.d[k] -= pair.p[k], pair.e[k] -= pair.q[k], r[k] = pair.p[k] - pair.q[k];
        pair.dd = dot(pair.d, pair.d), pair.ee = dot(pair.e, pair.e);
        pair.de = dot(pair.d, pair.e), pair.dr = dot(pair.d, r), pair.er = dot(pair.e, r);
        // Where edges are parallel the quotient may be infinite or no number; it is not selected
        // then.
        const Doubles denominator = pair.dd * pair.ee - pair.de * pair.de;
        const auto crossed = denominator > kParallelInDoubles * pair.dd * pair.ee;
        const Doubles start = (pair.de * pair.er - pair.dr * pair.ee) / denominator;
        const DoublePoint way = pair.way_from(clamped_to_one(select(crossed, start, Doubles(0.0)))),
                          other = pair.way_from(Doubles(1.0));
        // Of parallel edges one of the ends is among the closest points.
        const auto good = crossed | (dot(way, way) < dot(other, other));
        for (std::size_t k = 0; k < 3; ++k)
            store(select(good, way[k], other[k]), between.at[k].data() + first);
    }
}

/// Each triangle's extent along a direction, the first's from corner 0, its origin.
HWY_INLINE void find_slabs(const std::array<Doubles, 5>& at, Doubles& s_lo, Doubles& s_hi,
                           Doubles& t_lo, Doubles& t_hi)
{
    s_lo = s_hi = Doubles(0.0);
    t_lo = t_hi = at[2];
    for (std::size_t i = 0; i < 2; ++i) {
        lower_to(s_lo, at[i]), raise_to(s_hi, at[i]);
        lower_to(t_lo, at[3 + i]), raise_to(t_hi, at[3 + i]);
    }
}

void slabs_across(const PairLanes& pairs, const PointRow& ways, SlabLanes& slabs)
{
    for (std::size_t first = 0; first < kLanes; first += kDoubleLanes) {
        const DoublePoint way = load(ways, first);
        const Doubles squared = dot(way, way), length = square_root(squared);
        DoublePoint n;
        for (std::size_t k = 0; k < 3; ++k)
            // The plane is made of this rounded normal, so its slab has to be measured with it.
            n[k] = to_doubles(to_floats(way[k] / length));
        std::array<Doubles, 5> at;
        for (std::size_t i = 0; i < 5; ++i)
            at[i] = dot(n, load(pairs.corner[1 + i], first));
        Doubles s_lo, s_hi, t_lo, t_hi;
        find_slabs(at, s_lo, s_hi, t_lo, t_hi);
        // The first triangle may lie on either side; where it is the lower one, all is turned
        // round, the ends of the extents as well. A way of no length makes comparisons with no
        // number, which are false, and gets a gap that no pair accepts.
        const Doubles along = s_lo - t_hi, against = t_lo - s_hi;
        const auto plain = along > against;
        for (std::size_t k = 0; k < 3; ++k)
            store(to_floats(select(plain, n[k], -n[k])), slabs.n[k].data() + first);
        store(select(plain, s_lo, -s_hi), slabs.lo.data() + first);
        store(select(plain, t_hi, -t_lo), slabs.hi.data() + first);
        const Doubles no_gap(-std::numeric_limits<double>::max());
        store(select(length > 0.0, select(plain, along, against), no_gap),
              slabs.gap.data() + first);
        store(squared, slabs.squared.data() + first);
    }
}

} // namespace
} // namespace HWY_NAMESPACE
} // namespace vdb_shell::growth
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vdb_shell::growth
{

HWY_EXPORT(estimate_rooms);
HWY_EXPORT(between_edges);
HWY_EXPORT(slabs_across);

void estimate_rooms(const PairLanes& pairs, PairEstimates& estimates)
{
    VDB_SHELL_KERNEL(estimate_rooms)(pairs, estimates);
}

void between_edges(const EdgeRows& edges, PointRow& between)
{
    VDB_SHELL_KERNEL(between_edges)(edges, between);
}

void slabs_across(const PairLanes& pairs, const PointRow& ways, SlabLanes& slabs)
{
    VDB_SHELL_KERNEL(slabs_across)(pairs, ways, slabs);
}

} // namespace vdb_shell::growth
#endif
