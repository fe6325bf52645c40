// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdb_shell/volume/deform_volume.h"
#include "vdb_shell/volume/shell_map.h"

#include <openvdb/Grid.h>
#include <openvdb/math/Mat3.h>

#include <string>

namespace vdb_shell
{

/// How a place in the pose and its surroundings go back to rest.
struct Pullback {
    openvdb::Vec3d rest{0.0};                            ///< world units of the shell
    openvdb::Mat3d by_pose = openvdb::Mat3d::identity(); ///< d rest / d pose
    double volume_ratio = 1;                             ///< of rest over pose
};

/// Precondition: the place is of one of the two shells, and found.
Pullback pull_back(const ShellMap& rest, const ShellMap& posed, const ShellPlace& place);

/// What a pose does to a vector.
enum class VectorMap {
    keep,
    forward,     ///< turned and stretched
    normal,      ///< as a normal of the surface that it stands on, with its length
    unit_normal, ///< the same, made as long as 1
    rotate,
};

/// Throws InvalidOption where vectors are absolute places, and the rule is by type.
VectorMap vector_map(const openvdb::GridBase& grid, VectorRule rule);

/// `by_pose`: Pullback's.
openvdb::Vec3d carried_vector(const openvdb::Vec3d& vector, VectorMap map,
                              const openvdb::Mat3d& by_pose);

/// Throws InvalidOption, naming the grid, for more of it outside the shell than is allowed; shares.
void require_inside(const std::string& grid, double outside, double most_outside);

} // namespace vdb_shell
