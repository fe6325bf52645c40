// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <openvdb/Types.h>

#include <array>

namespace vdb_shell
{

/// The nearest point of a triangle and what of it that lies on: the face, side k (from corner k) or
/// corner k.
struct NearestOnTriangle {
    enum class On { face, side, corner };
    openvdb::Vec3d point{0.0};
    On on = On::face;
    int k = 0;
};

NearestOnTriangle nearest_on_triangle(const std::array<openvdb::Vec3d, 3>& corner,
                                      const openvdb::Vec3d& point);

inline double squared_distance(const std::array<openvdb::Vec3d, 3>& corner,
                               const openvdb::Vec3d& point)
{
    return (nearest_on_triangle(corner, point).point - point).lengthSqr();
}

/// The weights of its corners, none negative; of a triangle without area that doubles see, those of
/// the nearest corner.
std::array<double, 3> nearest_weights(const std::array<openvdb::Vec3d, 3>& corner,
                                      const openvdb::Vec3d& point);

} // namespace vdb_shell
