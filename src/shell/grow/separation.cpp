// SPDX-License-Identifier: Apache-2.0
#include "shell/grow/separation.h"

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

/// Takes the slab across `axis` when it is wider than the best so far.
void try_axis(const Vec3d& axis, const Pair& p, Slab& best)
{
    const double length = axis.length();
    if (!(length > 0))
        return;
    // The wall is made of this rounded normal, so its slab has to be measured with it.
    const Vec3s n(axis / length);
    const Vec3d m(n);
    const double s1 = m.dot(p.s[1]), s2 = m.dot(p.s[2]);
    const double t0 = m.dot(p.t[0]), t1 = m.dot(p.t[1]), t2 = m.dot(p.t[2]);
    const double s_lo = std::min({0.0, s1, s2}), s_hi = std::max({0.0, s1, s2});
    const double t_lo = std::min({t0, t1, t2}), t_hi = std::max({t0, t1, t2});
    if (s_lo - t_hi > best.gap)
        best = {n, s_lo, t_hi, s_lo - t_hi};
    if (t_lo - s_hi > best.gap)
        best = {-n, -s_hi, -t_lo, t_lo - s_hi};
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
    int at; ///< 3 * edge of the first + edge of the second
    double distance2;
};

/// The two edges, one of each triangle, that come closest, in units of `size`. The loop has no
/// branches, so that the compiler can do several pairs at a time.
template <class Real> EdgePair closest_edges(const Pair& pair, double size)
{
    constexpr int kPairs = 9, kLanes = 12; // whole vectors
    Real p[3][kLanes] = {}, d[3][kLanes] = {}, q[3][kLanes] = {}, e[3][kLanes] = {};
    Real distance2[kLanes];
    const double scale = 1 / size;
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
            for (int k = 0; k < 3; ++k) {
                const int at = 3 * i + j, i1 = (i + 1) % 3, j1 = (j + 1) % 3;
                p[k][at] = static_cast<Real>(scale * pair.s[i][k]);
                d[k][at] = static_cast<Real>(scale * (pair.s[i1][k] - pair.s[i][k]));
                q[k][at] = static_cast<Real>(scale * pair.t[j][k]);
                e[k][at] = static_cast<Real>(scale * (pair.t[j1][k] - pair.t[j][k]));
            }
    for (int at = 0; at < kLanes; ++at) {
        // Squares of it are far from underflow, which would cost more than all the rest.
        constexpr Real kTiny = Real(1e-12), kParallel = 16 * std::numeric_limits<Real>::epsilon();
        const Real rx = p[0][at] - q[0][at], ry = p[1][at] - q[1][at], rz = p[2][at] - q[2][at];
        const Real dx = d[0][at], dy = d[1][at], dz = d[2][at];
        const Real ex = e[0][at], ey = e[1][at], ez = e[2][at];
        const Real dd = dx * dx + dy * dy + dz * dz + kTiny;
        const Real ee = ex * ex + ey * ey + ez * ez + kTiny;
        const Real de = dx * ex + dy * ey + dz * ez;
        const Real dr = dx * rx + dy * ry + dz * rz, er = ex * rx + ey * ry + ez * rz;
        const auto least_of = [](Real x, Real y) { return x < y ? x : y; };
        const auto most_of = [](Real x, Real y) { return x > y ? x : y; };
        const Real denominator = most_of(dd * ee - de * de, kParallel * dd * ee);
        const auto share = [&](Real x) { return least_of(most_of(x, Real(0)), Real(1)); };
        const auto from = [&](Real start) {
            const Real t = share((de * start + er) / ee), s = share((de * t - dr) / dd);
            const Real x = rx + s * dx - t * ex, y = ry + s * dy - t * ey;
            const Real z = rz + s * dz - t * ez;
            return x * x + y * y + z * z;
        };
        // Of edges that are nearly parallel one end is among the closest points.
        distance2[at] = least_of(from(share((de * er - dr * ee) / denominator)),
                                 least_of(from(Real(0)), from(Real(1))));
    }
    const Real* const least = std::min_element(distance2, distance2 + kPairs);
    return {static_cast<int>(least - distance2), static_cast<double>(*least)};
}

void try_closest_edges(const Pair& p, Slab& best)
{
    // Below this distance, in units of the pair's size, float32 cannot choose.
    constexpr double kNear = 0.004;
    double size = 0;
    for (int i = 0; i < 3; ++i)
        for (int k = 0; k < 3; ++k)
            size = std::max({size, std::abs(p.s[i][k]), std::abs(p.t[i][k])});
    if (!(size > 0))
        return;
    EdgePair closest = closest_edges<float>(p, size);
    if (closest.distance2 < kNear * kNear)
        closest = closest_edges<double>(p, size);
    const int i = closest.at / 3, j = closest.at % 3;
    try_axis(between_segments(p.s[i], p.s[(i + 1) % 3] - p.s[i], p.t[j], p.t[(j + 1) % 3] - p.t[j]),
             p, best);
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
    Slab best;
    try_axis(p.t[0] + p.t[1] + p.t[2] - p.s[1] - p.s[2], p, best);
    if (best.gap > enough)
        return best;
    // A corner of one against the inside of the other: across that one's own plane.
    try_axis(first.normal, p, best);
    try_axis(second.normal, p, best);
    if (best.gap > enough)
        return best;
    try_closest_edges(p, best);
    return best;
}

} // namespace vdb_shell::growth
