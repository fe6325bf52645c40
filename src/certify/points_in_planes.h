// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace vdb_shell
{

/// The four planes of a tet by floats, moved outward by more than their rounding.
struct FloatPlanes {
    std::array<std::array<float, 3>, 4> outward; ///< unit normals
    std::array<float, 4> most;                   ///< beyond it along the normal, a point is outside
};

/// Points [begin, end) of a list.
struct PointRun {
    std::uint32_t begin, end;
};

/// Writes the places of those points of the runs that no plane has outside to `inside`, in order,
/// and gives back how many there are. A plane that is not a number has no point outside.
/// Preconditions: each axis of `points` can be read kLanes beyond the end of the last run; `inside`
/// has room for all points of the runs.
std::size_t points_in_planes(const std::array<const float*, 3>& points, const PointRun* runs,
                             std::size_t count, const FloatPlanes& planes, std::uint32_t* inside);

} // namespace vdb_shell
