// SPDX-License-Identifier: Apache-2.0

#include "field/level_set_again.h"

#include <openvdb/tools/LevelSetRebuild.h>
#include <openvdb/tools/SignedFloodFill.h>

namespace vdb_shell
{

void make_distances_again(openvdb::FloatGrid& grid, float half_width_voxels)
{
    openvdb::tools::signedFloodFill(grid.tree());
    make_distances_of_signed(grid, half_width_voxels);
}

void make_distances_of_signed(openvdb::FloatGrid& grid, float half_width_voxels)
{
    grid.setTree(openvdb::tools::levelSetRebuild(grid, 0.0f, half_width_voxels)->treePtr());
}

} // namespace vdb_shell
