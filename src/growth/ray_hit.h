// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "growth/predicates.h"

#include <limits>

namespace vdb_shell::growth
{

/// Parameter t > 0 where p + t d meets the triangle, or infinity. In plain doubles: for estimates.
inline double ray_hit(const Vec3d& p, const Vec3d& d, const Corners& c)
{
    constexpr double kNever = std::numeric_limits<double>::infinity();
    const Vec3d e1 = c[1] - c[0], e2 = c[2] - c[0], h = d.cross(e2);
    const double det = e1.dot(h);
    if (det == 0)
        return kNever;
    const Vec3d s = p - c[0], q = s.cross(e1);
    const double u = s.dot(h) / det, v = d.dot(q) / det, t = e2.dot(q) / det;
    return u < 0 || v < 0 || u + v > 1 || t <= 0 ? kNever : t;
}

} // namespace vdb_shell::growth
