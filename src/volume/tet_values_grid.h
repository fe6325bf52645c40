// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/stage_progress.h"
#include "vdb_shell/core/grid_types.h"
#include "vdb_shell/shell/tessellate.h"

#include <vector>

namespace vdb_shell
{

/// What shell_depth_grid does, of any values: a float grid over the voxels whose centres lie in a
/// tet, linear in each tet between the values of its points; without a name. Same bits for any
/// number of threads. Throws as shell_depth_grid does, its message opened by `what`.
FloatGridPtr tet_values_grid(const TetMesh& tets, const std::vector<double>& value,
                             double voxel_size, const char* what, const StageProgress& progress);

} // namespace vdb_shell
