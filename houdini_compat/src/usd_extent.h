// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdb_shell/write/vdb_file.h"

#include <openvdb/Types.h>

#include <string>
#include <vector>

namespace vdb_shell
{

/// The values of USD's attribute "extent": the box of the points.
std::string extent_of(const std::vector<openvdb::Vec3s>& points);

/// The box of all active voxels of both grids, which the shell has to have.
std::string extent_of_volume(const ShellFile& shell);

} // namespace vdb_shell
