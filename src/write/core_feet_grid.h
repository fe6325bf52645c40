// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "write/point_grid_builder.h"

#include "vdb_shell/write/shell_points.h"

#include <string>
#include <vector>

namespace vdb_shell
{

/// Columns `core`, `core_triangle`, `core_uvw` and `core_distance`; none where there are no feet.
void add_core_feet(PointGridBuilder& builder, const ShellPoints& points,
                   const std::vector<CoreFoot>& feet);

/// By vertex; empty where the grid has no such columns. Throws ReadError, its message opened by
/// `name`. Precondition: the ids of the grid have been found to be those of `points`.
std::vector<CoreFoot> read_core_feet(const openvdb::points::PointDataGrid& grid,
                                     const ShellPoints& points, const std::string& name);

} // namespace vdb_shell
