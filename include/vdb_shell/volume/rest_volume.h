// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdb_shell/core/grid_types.h"
#include "vdb_shell/core/interrupter.h"
#include "vdb_shell/shell/tessellate.h"

#include <vector>

namespace vdb_shell
{

/// Vector grid "rest" (vec3s) over the voxels whose centres lie in a posed tet, the active voxels
/// of shell_depth_grid: where that place is in the shell at rest, linear in each tet; background 0.
/// `rest`: by point of the tets (vectors_of_tet_points). Same bits for any number of threads.
/// Throws as shell_depth_grid does. Precondition: as many places at rest as points.
GridBasePtr rest_volume(const TetMesh& posed, const std::vector<openvdb::Vec3s>& rest,
                        double voxel_size, Interrupter* interrupter = nullptr);

/// The same of velocities: grid "v", whose vectors turn and grow with what they are in.
GridBasePtr velocity_volume(const TetMesh& posed, const std::vector<openvdb::Vec3s>& velocity,
                            double voxel_size, Interrupter* interrupter = nullptr);

} // namespace vdb_shell
