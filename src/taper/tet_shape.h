// SPDX-License-Identifier: Apache-2.0
#pragma once

// The shape of one tet as a function of one of its corners: what tapering minimises.

#include <openvdb/Types.h>

#include <array>
#include <cmath>

namespace vdb_shell::taper
{

using openvdb::Vec3d;
using TetCorners = std::array<Vec3d, 4>;

inline double six_volumes(const TetCorners& p)
{
    return (p[1] - p[0]).cross(p[2] - p[0]).dot(p[3] - p[0]);
}

inline double squared_edges(const TetCorners& p)
{
    return (p[1] - p[0]).lengthSqr() + (p[2] - p[0]).lengthSqr() + (p[3] - p[0]).lengthSqr() +
           (p[2] - p[1]).lengthSqr() + (p[3] - p[1]).lengthSqr() + (p[3] - p[2]).lengthSqr();
}

/// The distortion of a tet: 1 for a regular one, without bound as it becomes flat. It is
/// (AMIPS / 3)^1.5, and the mean ratio of Liu and Joe 1994 to the power of -1.5: squared edges and
/// volume then enter by a root and a quotient alone. Precondition: six_volumes > 0.
inline double distortion(double squared_edges, double six_volumes)
{
    const double per_edge = squared_edges / 12;
    return 2 * per_edge * std::sqrt(per_edge) / six_volumes;
}
inline double distortion_of_amips(double amips)
{
    const double ratio = amips / 3;
    return ratio * std::sqrt(ratio);
}
inline double amips_of_distortion(double distortion)
{
    return 3 * std::cbrt(distortion * distortion);
}

/// A symmetric 3 x 3 matrix.
struct Symmetric {
    double xx = 0, xy = 0, xz = 0, yy = 0, yz = 0, zz = 0;

    /// Adds w u u^T.
    void add(double w, const Vec3d& u)
    {
        xx += w * u[0] * u[0], xy += w * u[0] * u[1], xz += w * u[0] * u[2];
        yy += w * u[1] * u[1], yz += w * u[1] * u[2], zz += w * u[2] * u[2];
    }
    /// Adds w (u v^T + v u^T).
    void add(double w, const Vec3d& u, const Vec3d& v)
    {
        xx += 2 * w * u[0] * v[0], yy += 2 * w * u[1] * v[1], zz += 2 * w * u[2] * v[2];
        xy += w * (u[0] * v[1] + u[1] * v[0]), xz += w * (u[0] * v[2] + u[2] * v[0]);
        yz += w * (u[1] * v[2] + u[2] * v[1]);
    }
    void add_identity(double w) { xx += w, yy += w, zz += w; }
};

/// Solves h x = g by Cholesky; false where h is not safely positive. Comparisons are written so
/// that a NaN is refused like a negative pivot.
inline bool solve_positive(const Symmetric& h, const Vec3d& g, Vec3d& x)
{
    const double l00 = std::sqrt(h.xx);
    const double l10 = h.xy / l00, l20 = h.xz / l00;
    const double d1 = h.yy - l10 * l10;
    if (!(l00 > 0) || !(d1 > 0))
        return false;
    const double l11 = std::sqrt(d1), l21 = (h.yz - l20 * l10) / l11;
    const double d2 = h.zz - l20 * l20 - l21 * l21;
    if (!(d2 > 0))
        return false;
    const double y0 = g[0] / l00, y1 = (g[1] - l10 * y0) / l11;
    x[2] = (g[2] - l20 * y0 - l21 * y1) / d2;
    x[1] = (y1 - l21 * x[2]) / l11;
    x[0] = (y0 - l10 * x[1] - l20 * x[2]) / l00;
    return true;
}

/// Gradient of six_volumes in corner `free`. A rotation of four corners by one is an odd
/// permutation, hence the sign.
inline Vec3d volume6_gradient(const TetCorners& p, std::size_t free)
{
    const Vec3d &q = p[(free + 1) % 4], &r = p[(free + 2) % 4], &t = p[(free + 3) % 4];
    return (free % 2 == 0 ? -1.0 : 1.0) * (r - q).cross(t - q);
}

/// A power of the distortion: the larger, the more the worst tets count.
inline double weighed(double distortion, double power)
{
    // A root and some products are a tenth of the time of std::pow.
    const int halves = static_cast<int>(2 * power);
    if (2 * power != halves)
        return std::pow(distortion, power);
    double result = halves % 2 == 0 ? 1 : std::sqrt(distortion);
    for (int i = 0; i < halves / 2; ++i)
        result *= distortion;
    return result;
}

/// Adds gradient and Hessian of the distortion to the power given in corner `free`. A power of at
/// least 1 of what is convex and positive is convex, and the distortion itself is: with s the
/// gradient of the logarithm of the squared edges and n that of the volume, the Hessian is the
/// distortion times 9 / edges I + 3/4 s s^T - 3/2 (s n^T + n s^T) + 2 n n^T; |s|^2 is at most 12 /
/// edges, so the first term is at least 3/4 s s^T more, and 3/2 s s^T - 3/2 (s n^T + n s^T) + 2 n
/// n^T is positive definite. (docs/theory.md, "Tapered shells")
inline void add_distortion(const TetCorners& p, std::size_t free, double six_volumes, double power,
                           Vec3d& gradient, Symmetric& hessian)
{
    const Vec3d& x = p[free];
    const double edges = squared_edges(p);
    const Vec3d s =
        (2 / edges) * (3.0 * x - p[(free + 1) % 4] - p[(free + 2) % 4] - p[(free + 3) % 4]);
    const Vec3d n = volume6_gradient(p, free) / six_volumes;
    const double value = power * weighed(distortion(edges, six_volumes), power);
    const Vec3d slope = 1.5 * s - n; // of the logarithm
    gradient += value * slope;
    hessian.add_identity(value * 9 / edges);
    hessian.add(value * 0.75, s);
    hessian.add(value * -1.5, s, n);
    hessian.add(value * 2, n);
    hessian.add(value * (power - 1), slope);
}

} // namespace vdb_shell::taper
