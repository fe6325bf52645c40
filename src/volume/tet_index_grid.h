// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/grid_instances.h"
#include "volume/tet_columns.h"

#include <cstdint>
#include <vector>

namespace vdb_shell
{

/// The index of the tet over each voxel whose centre lies in one, the smallest where several do;
/// background -1. `wanted`: by tet, whether it counts; empty: all do. Same bits for any number of
/// threads. Throws as shell_depth_grid does, the message opened by `name`.
openvdb::Int32Grid::Ptr tet_index_grid(const TetMesh& tets, const VoxelLattice& lattice,
                                       const char* name, const StageProgress& progress,
                                       const std::vector<std::uint8_t>& wanted = {});

} // namespace vdb_shell
