// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "volume/tet_columns.h"

namespace vdb_shell
{

/// The lattice of a grid's voxels, `shift` taken off. Throws InvalidOption, naming the grid, for a
/// transform that does more than scale all axes alike and move.
VoxelLattice plain_lattice(const openvdb::GridBase& grid, const openvdb::Vec3d& shift);

} // namespace vdb_shell
