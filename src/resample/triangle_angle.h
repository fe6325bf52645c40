// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <openvdb/Types.h>

#include <algorithm>
#include <cmath>

namespace vdb_shell
{

/// Cosine of a triangle's smallest angle, which is opposite to its shortest side; 1 for one that
/// has shrunk to a line.
inline double cosine_of_smallest_angle(const openvdb::Vec3d& a, const openvdb::Vec3d& b,
                                       const openvdb::Vec3d& c)
{
    const double x = (b - a).lengthSqr(), y = (c - b).lengthSqr(), z = (a - c).lengthSqr();
    const double least = std::min({x, y, z});
    const double product = least == x ? y * z : least == y ? x * z : x * y;
    return product > 0 ? 0.5 * (x + y + z - 2 * least) / std::sqrt(product) : 1.0;
}

} // namespace vdb_shell
