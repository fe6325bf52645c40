// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <openvdb/Types.h>

namespace vdb_shell
{

/// A vector of length 1 along v, zero for zero. OpenVDB's normalize() leaves what is shorter than
/// 1e-7 as it is, as the normal of a triangle is whose sides are a few ten-thousandths long.
inline openvdb::Vec3d unit_vector(const openvdb::Vec3d& v)
{
    const double length = v.length();
    return length > 0 ? v / length : openvdb::Vec3d(0.0);
}

} // namespace vdb_shell
