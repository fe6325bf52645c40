// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/point_grid_instances.h"
#include "vdb_shell/write/input_points.h"

#include <cstddef>
#include <cstdint>
#include <string>

namespace vdb_shell
{

inline constexpr const char* kInputPointsGrid = "input_points";

/// Precondition: require_consistent; there are points.
openvdb::points::PointDataGrid::Ptr make_input_points_grid(const InputPoints& input);

/// Throws ReadError, its message opened by `name`, unless every id is there once and in range.
InputPoints read_input_points_grid(const openvdb::points::PointDataGrid& grid, std::int64_t count,
                                   std::size_t vertices, const std::string& name);

} // namespace vdb_shell
