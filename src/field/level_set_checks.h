// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdb_shell/field/level_set.h"

namespace vdb_shell
{

/// The voxel size, once mesh, options, voxel size and memory have been found fit: throws what
/// mesh_to_level_set throws.
double checked_voxel_size(const TriangleMesh& mesh, const LevelSetOptions& options);

/// Name, class and creator.
void finish_level_set(openvdb::FloatGrid& grid);

} // namespace vdb_shell
