// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/grid_instances.h"
#include "vdb_shell/shell/tessellate.h"

#include <string>

namespace vdb_shell
{

/// Refuses voxels over tets before any is made, as the level set of a build does: some that are
/// larger than the shell, of which no grid would come, and more than memory has room for, which
/// would end the process without a word. `bytes`: of all grids for one voxel. `name` opens the
/// messages. Throws GeometryError; InvalidOption for a size that is not positive and finite.
void require_voxels_fit(const TetMesh& tets, double voxel_size, double bytes,
                        const std::string& name);

/// Throws GeometryError where no voxel of the grid of tets is active: all lie between the centres
/// of voxels, and a file without a voxel would look like a success.
void require_voxels_inside(const openvdb::Int32Grid& inside, const TetMesh& tets,
                           const std::string& name);

} // namespace vdb_shell
