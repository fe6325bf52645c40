// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <openvdb/Types.h>

#include <array>

namespace vdb_shell
{

using TetCorners = std::array<openvdb::Vec3d, 4>;

/// Six times the signed volume of a tet.
inline double six_volumes(const TetCorners& p)
{
    return (p[1] - p[0]).cross(p[2] - p[0]).dot(p[3] - p[0]);
}

/// Gradient of six_volumes in corner `free`. A rotation of four corners by one is an odd
/// permutation, hence the sign.
inline openvdb::Vec3d volume6_gradient(const TetCorners& p, std::size_t free)
{
    const openvdb::Vec3d &q = p[(free + 1) % 4], &r = p[(free + 2) % 4], &t = p[(free + 3) % 4];
    return (free % 2 == 0 ? -1.0 : 1.0) * (r - q).cross(t - q);
}

} // namespace vdb_shell
