// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <openvdb/Types.h>

#include <cmath>

namespace vdb_shell
{

/// Whether voxels have numbers around a place in index space: farther out, or where it is not a
/// number, it cannot be rounded to a Coord.
inline bool has_voxel_numbers(const openvdb::Vec3d& index)
{
    constexpr double kMost = 1 << 30; // half of what fits, so that differences fit too
    return std::abs(index[0]) < kMost && std::abs(index[1]) < kMost && std::abs(index[2]) < kMost;
}

} // namespace vdb_shell
