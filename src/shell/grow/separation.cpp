// SPDX-License-Identifier: Apache-2.0
#include "shell/grow/separation.h"

#include "core/two_targets.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstring>

namespace vdb_shell::growth
{
namespace
{

/// All corners relative to the first triangle's first: an object far from the origin keeps its
/// digits.
struct Pair {
    std::array<Vec3d, 3> s, t;
};

Pair relative(const Corners& s, const Corners& t)
{
    return {{Vec3d(0.0), s[1] - s[0], s[2] - s[0]}, {t[0] - s[0], t[1] - s[0], t[2] - s[0]}};
}

Slab slab_across(const Vec3d& axis, const Pair& p)
{
    Slab slab;
    const double length = axis.length();
    if (!(length > 0))
        return slab;
    // The wall is made of this rounded normal, so its slab has to be measured with it.
    const Vec3s n(axis / length);
    const Vec3d m(n);
    const double s1 = m.dot(p.s[1]), s2 = m.dot(p.s[2]);
    const double t0 = m.dot(p.t[0]), t1 = m.dot(p.t[1]), t2 = m.dot(p.t[2]);
    const double s_lo = std::min({0.0, s1, s2}), s_hi = std::max({0.0, s1, s2});
    const double t_lo = std::min({t0, t1, t2}), t_hi = std::max({t0, t1, t2});
    return s_lo - t_hi > t_lo - s_hi ? Slab{n, s_lo, t_hi, s_lo - t_hi}
                                     : Slab{-n, -s_hi, -t_lo, t_lo - s_hi};
}

/// From the closest point of the segment p + [0, 1] d to that of q + [0, 1] e (Ericson 2005,
/// "Real-Time Collision Detection", 5.1.9).
Vec3d between_segments(const Vec3d& p, const Vec3d& d, const Vec3d& q, const Vec3d& e)
{
    constexpr double kParallel = 1e-12;
    const Vec3d r = p - q;
    const double dd = d.lengthSqr(), ee = e.lengthSqr(), de = d.dot(e), dr = d.dot(r),
                 er = e.dot(r);
    const double denominator = dd * ee - de * de;
    const auto from = [&](double start) {
        const double t = ee > 0 ? std::clamp((de * start + er) / ee, 0.0, 1.0) : 0.0;
        const double s = dd > 0 ? std::clamp((de * t - dr) / dd, 0.0, 1.0) : 0.0;
        return (q + t * e) - (p + s * d);
    };
    if (denominator > kParallel * dd * ee)
        return from(std::clamp((de * er - dr * ee) / denominator, 0.0, 1.0));
    const Vec3d one = from(0.0), other = from(1.0);
    return one.lengthSqr() < other.lengthSqr() ? one : other;
}

/// Corners 1 and 2 of the first triangles and all of the second, relative to corner 0 of the first,
/// by axis; a pair to a lane.
struct PairLanes {
    alignas(kLanesAlignment) std::array<std::array<std::array<float, kLanes>, 3>, 5> at;
    alignas(kLanesAlignment) std::array<float, kLanes> enough;
};

/// What floats see of each pair. Rooms are in units of its size, the largest coordinate.
struct Sight {
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

/// The room across an axis of any length, in units of the pair; of c[0] to c[4] as in PairLanes.
VDB_SHELL_LANES_PART void room_across(const LanePoint& axis, const std::array<LanePoint, 5>& c,
                                      Lanes& out)
{
    std::array<Lanes, 5> d;
    for (std::size_t i = 0; i < 5; ++i)
        dot(axis, c[i], d[i]);
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
VDB_SHELL_LANES_PART void closest_edges(const std::array<LanePoint, 3>& p,
                                        const std::array<LanePoint, 3>& q, Lanes& least,
                                        Lanes& which)
{
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

VDB_SHELL_TWO_TARGETS void look_at(const PairLanes& pairs, Sight& sight)
{
    std::array<LanePoint, 5> c;
    Lanes size{};
    for (std::size_t i = 0; i < 5; ++i)
        for (std::size_t k = 0; k < 3; ++k) {
            std::memcpy(&c[i][k], pairs.at[i][k].data(), sizeof(Lanes));
            raise_to(size, c[i][k]);
            raise_to(size, -c[i][k]);
        }
    const Lanes inverse = 1 / (size + std::numeric_limits<float>::min());
    for (LanePoint& point : c)
        for (Lanes& x : point)
            x *= inverse;
    Lanes enough;
    std::memcpy(&enough, pairs.enough.data(), sizeof enough);
    enough = enough * inverse + kErrorOfRoom;

    LanePoint u, w, normal, middles;
    for (std::size_t k = 0; k < 3; ++k)
        middles[k] = c[2][k] + c[3][k] + c[4][k] - c[0][k] - c[1][k];
    Lanes across_middles, across_first, across_second;
    room_across(middles, c, across_middles);
    cross(c[0], c[1], normal);
    room_across(normal, c, across_first);
    difference(c[3], c[2], u), difference(c[4], c[2], w);
    cross(u, w, normal);
    room_across(normal, c, across_second);
    Lanes widest = across_middles;
    raise_to(widest, across_first);
    raise_to(widest, across_second);
    sight.wide = bits_of(widest > enough);

    Lanes squared, edges;
    closest_edges({LanePoint{}, c[0], c[1]}, {c[2], c[3], c[4]}, squared, edges);
    sight.close = bits_of(squared < kClose * kClose);
    std::memcpy(sight.edges.data(), &edges, sizeof edges);
    across_middles *= size, across_first *= size, across_second *= size;
    std::memcpy(sight.across_middles.data(), &across_middles, sizeof edges);
    std::memcpy(sight.across_first.data(), &across_first, sizeof edges);
    std::memcpy(sight.across_second.data(), &across_second, sizeof edges);
}

Vec3d between_edges(const Pair& p, int i, int j)
{
    return between_segments(p.s[i], p.s[(i + 1) % 3] - p.s[i], p.t[j], p.t[(j + 1) % 3] - p.t[j]);
}

/// The same in doubles, for edges so close that floats cannot choose.
Vec3d between_closest_edges(const Pair& p)
{
    Vec3d least;
    double distance2 = std::numeric_limits<double>::max();
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) {
            const Vec3d between = between_edges(p, i, j);
            if (between.lengthSqr() < distance2)
                least = between, distance2 = between.lengthSqr();
        }
    return least;
}

Vec3d normal_of(const Vec3d& a, const Vec3d& b, const Vec3d& c)
{
    return (b - a).cross(c - a);
}

/// The widest slab, of which floats have seen which edges are closest and what other axes there
/// are.
Slab widest_slab(const Pair& p, const Sight& sight, std::size_t lane)
{
    const auto edges = static_cast<int>(sight.edges[lane]);
    const Vec3d between = (sight.close >> lane & 1U) != 0U ? between_closest_edges(p)
                                                           : between_edges(p, edges / 3, edges % 3);
    const Slab across = slab_across(between, p);
    // No slab is wider than two points are apart: most pairs end here.
    constexpr double kAll = 1 - 1e-6;
    if (across.gap > kAll * between.length())
        return across;
    // A corner of one against the inside of the other: across that one's own plane. Or whatever
    // keeps them apart.
    const auto first = static_cast<double>(sight.across_first[lane]),
               second = static_cast<double>(sight.across_second[lane]),
               middles = static_cast<double>(sight.across_middles[lane]);
    const double widest = std::max({first, second, middles});
    if (across.gap >= widest)
        return across;
    const Slab other = slab_across(widest == first    ? normal_of(p.s[0], p.s[1], p.s[2])
                                   : widest == second ? normal_of(p.t[0], p.t[1], p.t[2])
                                                      : p.t[0] + p.t[1] + p.t[2] - p.s[1] - p.s[2],
                                   p);
    return other.gap > across.gap ? other : across;
}

} // namespace

void slabs_between(const SlabQuery* query, std::size_t count, Slab* slab)
{
    assert(count <= kSlabsAtOnce);
    std::array<Pair, kLanes> pair;
    PairLanes lanes{};
    for (std::size_t i = 0; i < count; ++i) {
        pair[i] = relative(query[i].first, query[i].second);
        const Pair& p = pair[i];
        for (std::size_t k = 0; k < 3; ++k) {
            const auto at = [&](const Vec3d& x) { return static_cast<float>(x[int(k)]); };
            lanes.at[0][k][i] = at(p.s[1]), lanes.at[1][k][i] = at(p.s[2]);
            for (std::size_t j = 0; j < 3; ++j)
                lanes.at[2 + j][k][i] = at(p.t[j]);
        }
        lanes.enough[i] = static_cast<float>(query[i].enough);
    }
    Sight sight;
    look_at(lanes, sight);
    Slab wide;
    wide.gap = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < count; ++i)
        slab[i] = (sight.wide >> i & 1U) != 0U ? wide : widest_slab(pair[i], sight, i);
}

} // namespace vdb_shell::growth
