// SPDX-License-Identifier: Apache-2.0
#include "shell/grow/separation.h"

#include "core/four_floats.h"

#include <algorithm>
#include <cmath>

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

/// The room between the triangles across an axis, in units of the axis' length.
double room_across(const Vec3d& axis, const Pair& p)
{
    const double s1 = axis.dot(p.s[1]), s2 = axis.dot(p.s[2]);
    const double t0 = axis.dot(p.t[0]), t1 = axis.dot(p.t[1]), t2 = axis.dot(p.t[2]);
    const double above = std::min({0.0, s1, s2}) - std::max({t0, t1, t2});
    const double below = std::min({t0, t1, t2}) - std::max({0.0, s1, s2});
    return std::max(above, below);
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

struct EdgePair {
    int i, j; ///< edge of the first, edge of the second
    double distance2;
};

/// What the three edges of the second triangle have to say to one edge of the first, one to a lane.
struct EdgeLanes {
    FourFloats x, y, z, dx, dy, dz; ///< where they begin, and how they run
    FourFloats squared, inverse;    ///< of their lengths
};

// Squares of it are far from underflow, which would cost more than all the rest.
constexpr float kTiny = 1e-12F;

EdgeLanes edges_of(const std::array<Vec3d, 3>& corner, double scale)
{
    EdgeLanes e{};
    for (int j = 0; j < 4; ++j) {
        const Vec3d& p = corner[j % 3]; // the fourth lane is the first once more
        const Vec3d run = corner[(j + 1) % 3] - p;
        e.x[j] = static_cast<float>(scale * p[0]), e.dx[j] = static_cast<float>(scale * run[0]);
        e.y[j] = static_cast<float>(scale * p[1]), e.dy[j] = static_cast<float>(scale * run[1]);
        e.z[j] = static_cast<float>(scale * p[2]), e.dz[j] = static_cast<float>(scale * run[2]);
    }
    e.squared = e.dx * e.dx + e.dy * e.dy + e.dz * e.dz + four(kTiny);
    e.inverse = four(1) / e.squared;
    return e;
}

/// Squared distances of the edge p + [0, 1] d from three others.
FourFloats distances2(const Vec3s& p, const Vec3s& d, const EdgeLanes& e)
{
    constexpr float kParallel = 16 * std::numeric_limits<float>::epsilon();
    const FourFloats zero{}, one = four(1);
    const float dd = d.dot(d) + kTiny, dd_inverse = 1 / dd;
    const FourFloats rx = p[0] - e.x, ry = p[1] - e.y, rz = p[2] - e.z;
    const FourFloats de = d[0] * e.dx + d[1] * e.dy + d[2] * e.dz;
    const FourFloats dr = d[0] * rx + d[1] * ry + d[2] * rz;
    const FourFloats er = e.dx * rx + e.dy * ry + e.dz * rz;
    const auto share = [&](const FourFloats& x) { return least_of(most_of(x, zero), one); };
    const auto from = [&](const FourFloats& start) {
        const FourFloats t = share((de * start + er) * e.inverse);
        const FourFloats s = share((de * t - dr) * dd_inverse);
        const FourFloats x = rx + s * d[0] - t * e.dx, y = ry + s * d[1] - t * e.dy;
        const FourFloats z = rz + s * d[2] - t * e.dz;
        return x * x + y * y + z * z;
    };
    const FourFloats most = dd * e.squared;
    const FourFloats denominator = most_of(most - de * de, kParallel * most);
    // Of edges that are nearly parallel one end is among the closest points.
    return least_of(from(share((de * er - dr * e.squared) / denominator)),
                    least_of(from(zero), from(one)));
}

/// The two edges, one of each triangle, that come closest, in units of `size`, as floats see it.
EdgePair closest_edges(const Pair& pair, double size)
{
    const double scale = 1 / size;
    const EdgeLanes e = edges_of(pair.t, scale);
    EdgePair closest{0, 0, std::numeric_limits<double>::max()};
    for (int i = 0; i < 3; ++i) {
        const Vec3d run = pair.s[(i + 1) % 3] - pair.s[i];
        const FourFloats found = distances2(Vec3s(scale * pair.s[i]), Vec3s(scale * run), e);
        for (int j = 0; j < 3; ++j)
            if (static_cast<double>(found[j]) < closest.distance2)
                closest = {i, j, static_cast<double>(found[j])};
    }
    return closest;
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

double size_of(const Pair& p)
{
    double size = 0;
    for (int i = 0; i < 3; ++i)
        for (int k = 0; k < 3; ++k)
            size = std::max({size, std::abs(p.s[i][k]), std::abs(p.t[i][k])});
    return size;
}

/// From one triangle to the other where their edges come closest; zero where they touch.
Vec3d across_edges(const Pair& p)
{
    // Below this distance, in units of the pair's size, float32 cannot choose.
    constexpr double kNear = 0.004;
    const double size = size_of(p);
    if (!(size > 0))
        return Vec3d(0.0);
    const EdgePair closest = closest_edges(p, size);
    return closest.distance2 < kNear * kNear ? between_closest_edges(p)
                                             : between_edges(p, closest.i, closest.j);
}

} // namespace

Body body_of(const Corners& corner, double reach)
{
    const Vec3d normal = (corner[1] - corner[0]).cross(corner[2] - corner[0]);
    const double length = normal.length();
    return {corner, length > 0 ? normal / length : Vec3d(0.0), reach};
}

Slab slab_between(const Body& first, const Body& second, double enough)
{
    const Pair p = relative(first.corner, second.corner);
    Slab wide;
    wide.gap = std::numeric_limits<double>::infinity();
    const Vec3d middles = p.t[0] + p.t[1] + p.t[2] - p.s[1] - p.s[2];
    const double room = room_across(middles, p), squared = middles.lengthSqr();
    if (room > 0 && room * room > enough * enough * squared)
        return wide;
    // A corner of one against the inside of the other: across that one's own plane.
    const double across_first = room_across(first.normal, p);
    const double across_second = room_across(second.normal, p);
    if (std::max(across_first, across_second) > enough)
        return wide;
    const Vec3d edges = across_edges(p);
    const Slab across = slab_across(edges, p);
    // No slab is wider than two points are apart: most pairs end here.
    constexpr double kAll = 1 - 1e-6;
    if (across.gap > kAll * edges.length())
        return across;
    const double widest = std::max({0.0, across.gap, across_first, across_second});
    if (room > 0 && room * room > widest * widest * squared)
        return slab_across(middles, p);
    if (across.gap >= widest)
        return across;
    return slab_across(across_first >= across_second ? first.normal : second.normal, p);
}

} // namespace vdb_shell::growth
