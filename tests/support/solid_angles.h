// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "field/winding_number.h"

#include <cmath>

namespace vdb_shell::test
{

/// Signed solid angle over the full one (van Oosterom and Strackee), in doubles.
inline double turns_of(const TriangleCorners& t, const openvdb::Vec3d& p)
{
    const openvdb::Vec3d a = t[0] - p, b = t[1] - p, c = t[2] - p;
    const double la = a.length(), lb = b.length(), lc = c.length();
    return std::atan2(a.dot(b.cross(c)),
                      la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb) /
           (2 * M_PI);
}

} // namespace vdb_shell::test
