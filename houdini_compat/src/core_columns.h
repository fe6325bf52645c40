// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdb_shell/houdini/geometry.h"
#include "vdb_shell/write/shell_points.h"

#include "shell_columns.h"

#include <string>
#include <vector>

namespace vdb_shell::houdini
{

/// Point attributes `core`, `core_triangle`, `core_uvw` and `core_distance`; none where there are
/// no feet.
void add_core_attributes(const ShellPoints& points, const std::vector<CoreFoot>& feet,
                         HoudiniGeometry& geometry);

/// By vertex; empty where the geometry has no such attributes. Throws ReadError.
std::vector<CoreFoot> read_core_attributes(const HoudiniGeometry& geometry, const Columns& columns,
                                           const ShellStack& stack, const std::string& name);

} // namespace vdb_shell::houdini
