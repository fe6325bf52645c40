// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <openvdb/Types.h>

#include <cmath>

namespace vdb_shell
{

/// A symmetric 3 x 3 matrix, by columns of the lower triangle.
struct Symmetric {
    double xx = 0, xy = 0, xz = 0, yy = 0, yz = 0, zz = 0;

    /// Adds w u u^T.
    void add(double w, const openvdb::Vec3d& u)
    {
        xx += w * u[0] * u[0], xy += w * u[0] * u[1], xz += w * u[0] * u[2];
        yy += w * u[1] * u[1], yz += w * u[1] * u[2], zz += w * u[2] * u[2];
    }
    /// Adds w (u v^T + v u^T).
    void add(double w, const openvdb::Vec3d& u, const openvdb::Vec3d& v)
    {
        xx += 2 * w * u[0] * v[0], yy += 2 * w * u[1] * v[1], zz += 2 * w * u[2] * v[2];
        xy += w * (u[0] * v[1] + u[1] * v[0]), xz += w * (u[0] * v[2] + u[2] * v[0]);
        yz += w * (u[1] * v[2] + u[2] * v[1]);
    }
    /// Adds w times another.
    void add(double w, const Symmetric& o)
    {
        xx += w * o.xx, xy += w * o.xy, xz += w * o.xz;
        yy += w * o.yy, yz += w * o.yz, zz += w * o.zz;
    }
    void add_identity(double w) { xx += w, yy += w, zz += w; }
};

/// Solves h x = g by Cholesky; false where h is not safely positive, or x not finite. Comparisons
/// are written so that a NaN is refused like a negative pivot.
inline bool solve_positive(const Symmetric& h, const openvdb::Vec3d& g, openvdb::Vec3d& x)
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
    const double y2 = (g[2] - l20 * y0 - l21 * y1) / l22;
    x[2] = y2 / l22;
    x[1] = (y1 - l21 * x[2]) / l11;
    x[0] = (y0 - l10 * x[1] - l20 * x[2]) / l00;
    // Surfaces of 1e18 units, or with triangles of 1e-20, leave the range of doubles on the way.
    return x.isFinite();
}

} // namespace vdb_shell
