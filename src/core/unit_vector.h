// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <openvdb/Types.h>

#include <cmath>

namespace vdb_shell
{

/// A vector of length 1 along v, zero for zero. OpenVDB's normalize() leaves what is shorter than
/// 1e-7 as it is, as the normal of a triangle is whose sides are a few ten-thousandths long.
inline openvdb::Vec3d unit_vector(const openvdb::Vec3d& v)
{
    const double length = v.length();
    return length > 0 ? v / length : openvdb::Vec3d(0.0);
}

/// A vector at right angles to v, zero for zero, not of length 1: the product with the axis along
/// which v is shortest, for that makes the largest angle with it.
inline openvdb::Vec3d at_right_angles_to(const openvdb::Vec3d& v)
{
    int axis = 0;
    for (int k = 1; k < 3; ++k)
        if (std::abs(v[k]) < std::abs(v[axis]))
            axis = k;
    openvdb::Vec3d other(0.0);
    other[axis] = 1;
    return v.cross(other);
}

} // namespace vdb_shell
