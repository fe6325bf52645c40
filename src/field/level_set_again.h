// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/grid_instances.h"

namespace vdb_shell
{

/// Makes a narrow band of values that are negative inside, whatever their slope, a level set of
/// distances with as many voxels on either side of its surface.
void make_distances_again(openvdb::FloatGrid& grid, float half_width_voxels);

/// The same of a grid whose inactive values have their signs already.
void make_distances_of_signed(openvdb::FloatGrid& grid, float half_width_voxels);

} // namespace vdb_shell
