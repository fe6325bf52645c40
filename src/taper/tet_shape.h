// SPDX-License-Identifier: Apache-2.0
#pragma once

// The shape of one tet as a function of one of its corners: what tapering minimises.

#include "core/six_volumes.h"
#include "core/symmetric.h"

#include <openvdb/Types.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace vdb_shell::taper
{

using openvdb::Vec3d;

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

/// SOFA's rule on one tet (shell/quality.h), without an angle or a root: the sine of the angle at
/// an edge is six volumes times its length over the double areas of its two faces, and it is at
/// least that of 20 degrees from 20 to 160 degrees. Precondition: six_volumes > 0.
inline bool breaks_sofa_rule(const TetCorners& p, double six_volumes)
{
    constexpr double kSquaredSine = 0.116977778440511; // of 20 degrees
    constexpr double kSquaredRatio = 100;              // of edges
    const Vec3d a = p[1] - p[0], b = p[2] - p[0], c = p[3] - p[0];
    const Vec3d d = b - a, e = c - a, f = c - b;
    const std::array<double, 6> squared{a.lengthSqr(), b.lengthSqr(), c.lengthSqr(),
                                        d.lengthSqr(), e.lengthSqr(), f.lengthSqr()};
    const auto [least, most] = std::minmax_element(squared.begin(), squared.end());
    if (*most > kSquaredRatio * *least)
        return true;
    // Of the faces opposite to corners 0 to 3.
    const std::array<double, 4> area{d.cross(e).lengthSqr(), b.cross(c).lengthSqr(),
                                     a.cross(c).lengthSqr(), a.cross(b).lengthSqr()};
    const double volume = six_volumes * six_volumes / kSquaredSine;
    const auto flat = [&](std::size_t edge, std::size_t k, std::size_t l) {
        return volume * squared[edge] < area[k] * area[l];
    };
    return flat(0, 2, 3) || flat(1, 1, 3) || flat(2, 1, 2) || flat(3, 0, 3) || flat(4, 0, 2) ||
           flat(5, 0, 1);
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
