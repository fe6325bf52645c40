// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdb_shell/resample/surface_distance.h"

#include <openvdb/Types.h>

#include <cstdint>
#include <vector>

namespace vdb_shell
{

/// A point of one surface that is too far from another.
struct FarPoint {
    openvdb::Vec3d point{0.0};
    std::uint32_t triangle = 0; ///< of the other surface, the nearest
};

/// The triangles of all of them, each once, ascending.
std::vector<std::uint32_t> triangles_of(const std::vector<FarPoint>& far);

/// As surface_distance of three arguments; adds to `far` the points farther than the limit.
DistanceFigures surface_distance(const TriangleMesh& from, const TriangleMesh& to, double spacing,
                                 double limit, std::vector<FarPoint>& far,
                                 Interrupter* interrupter = nullptr);

/// The triangle nearest to each point.
std::vector<std::uint32_t> nearest_triangles(const TriangleMesh& surface,
                                             const std::vector<openvdb::Vec3d>& points);

} // namespace vdb_shell
