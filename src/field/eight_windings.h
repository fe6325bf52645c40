// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "mesh/eight_distances.h"

#include <array>
#include <cstddef>

// How often triangles turn around eight points at once, in floats, relative to a place nearby.

namespace vdb_shell
{

/// A far cluster of triangles: its centre, and the sum of areas times normals.
struct FarCluster {
    std::array<float, 3> centre, area_normal;
};

/// A triangle that is near to some of the points that it is looked at for.
struct NearTriangle {
    std::array<std::array<float, 3>, 3> corners; ///< by corner and axis
    FarCluster from_afar;
    float squared_far; ///< of the distance from which it may be looked at from afar
};

/// The turns, 1 for a closed surface around a point, of all clusters as dipoles and of all
/// triangles: as dipoles too where all eight points are far from them, by their solid angles else.
/// A triangle whose plane a point lies in counts 0 there. The same bits on every processor.
/// Precondition: no point is at a cluster's centre.
void turns_around(const FarCluster* clusters, std::size_t cluster_count,
                  const NearTriangle* triangles, std::size_t triangle_count,
                  const EightPoints& points, std::array<float, kLanes>& turns);

} // namespace vdb_shell
