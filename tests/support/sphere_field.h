// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "support/shapes.h"
#include "vdb_shell/field/level_set.h"

namespace vdb_shell::test
{

/// A unit sphere's level set of voxels of 0.05 named "surface", with values down to that depth.
inline openvdb::FloatGrid::Ptr sphere_field(double depth)
{
    LevelSetOptions options;
    options.voxel_size = 0.05;
    options.interior_depth = depth;
    return mesh_to_level_set(icosphere(1.0, 3), options);
}

} // namespace vdb_shell::test
