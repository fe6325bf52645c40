// SPDX-License-Identifier: Apache-2.0
#pragma once

// The shape of one tet as a function of one of its corners: what tapering minimises.

#include <openvdb/Types.h>

#include <array>
#include <cmath>

namespace vdb_shell::taper
{

using openvdb::Vec3d;

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
    /// Adds w to the diagonal.
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
    const double l22 = std::sqrt(d2);
    const double y0 = g[0] / l00, y1 = (g[1] - l10 * y0) / l11;
    x[2] = (g[2] - l20 * y0 - l21 * y1) / l22 / l22;
    x[1] = (y1 - l21 * x[2]) / l11;
    x[0] = (y0 - l10 * x[1] - l20 * x[2]) / l00;
    return true;
}

inline double six_volumes(const Vec3d& a, const Vec3d& b, const Vec3d& c, const Vec3d& d)
{
    return (b - a).cross(c - a).dot(d - a);
}

/// AMIPS over its value for a regular tet: the squared edges of the tet over those of the regular
/// tet of the same volume; 1 for a regular tet, without bound as it becomes flat, and the inverse of
/// the mean ratio of Liu and Joe 1994. Precondition: six_volumes > 0.
inline double amips(const std::array<Vec3d, 4>& p, double six_volumes)
{
    const double edges = (p[1] - p[0]).lengthSqr() + (p[2] - p[0]).lengthSqr() +
                         (p[3] - p[0]).lengthSqr() + (p[2] - p[1]).lengthSqr() +
                         (p[3] - p[1]).lengthSqr() + (p[3] - p[2]).lengthSqr();
    const double root = std::cbrt(0.5 * six_volumes);
    return edges / (12 * root * root);
}

/// Adds gradient and Hessian of amips^exponent in corner `free`, whatever its position among the
/// four. The function is convex: with s = grad(edges) / edges and n = grad(volume) / volume its
/// Hessian is amips (6 / edges I - 2/3 (s n^T + n s^T) + 10/9 n n^T), and |s|^2 <= 12 / edges.
inline void add_shape(const std::array<Vec3d, 4>& p, std::size_t free, double six_volumes,
                      double exponent, Vec3d& gradient, Symmetric& hessian)
{
    const Vec3d& x = p[free];
    const Vec3d &q = p[(free + 1) % 4], &r = p[(free + 2) % 4], &t = p[(free + 3) % 4];
    const double edges = (q - x).lengthSqr() + (r - x).lengthSqr() + (t - x).lengthSqr() +
                         (q - r).lengthSqr() + (q - t).lengthSqr() + (r - t).lengthSqr();
    const Vec3d s = (2 / edges) * (3.0 * x - q - r - t);
    // Cyclic rotations of four corners are odd permutations, hence the sign for an odd `free`.
    Vec3d n = (r - q).cross(t - q);
    n *= (free % 2 == 0 ? -1.0 : 1.0) / six_volumes;
    const double root = std::cbrt(0.5 * six_volumes);
    const double value = edges / (12 * root * root);
    const double power = exponent == 1 ? value : std::pow(value, exponent);
    const Vec3d slope = s - (2.0 / 3.0) * n; // of log(amips)
    gradient += (exponent * power) * slope;
    // Of value^e: e value^(e-1) Hess(value) + e (e-1) value^e slope slope^T.
    const double w = exponent * power;
    hessian.add_identity(w * 6 / edges);
    hessian.add(-w * 2.0 / 3.0, s, n);
    hessian.add(w * 10.0 / 9.0, n);
    hessian.add(w * (exponent - 1), slope);
}

} // namespace vdb_shell::taper
