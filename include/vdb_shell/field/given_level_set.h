// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdb_shell/field/level_set.h"
#include "vdb_shell/mesh/triangle_mesh.h"

#include <filesystem>
#include <string>

namespace vdb_shell
{

/// The level set of a .vdb from any tool: by name, or the only float grid of class level set when
/// `name` is empty. Half floats are floats. Throws ReadError for a file that cannot be read, that
/// has no such grid, several level sets and no name, or a grid that is not of floats; and
/// GeometryError as require_level_set does. Messages name file, grid and property.
FloatGridPtr read_level_set(const std::filesystem::path& path, const std::string& name);

/// Throws GeometryError when the grid's surface cannot be meshed: its class is not level set, its
/// transform is no linear one (a frustum), a value is not finite, the background is not positive,
/// or nothing is inside or outside. `where` (file and grid) opens the message.
void require_level_set(const openvdb::FloatGrid& grid, const std::string& where);

/// Why lines cannot step through the field itself, or an empty string when they can. They need
/// voxels that are cubes (they may be turned), at least three voxels of band outside and a band
/// inside as deep as a line may go (or all of the inside), distances for values (a slope of one at
/// the surface) and, when the options give one, the voxel size asked for. `surface` is the field's
/// own contour.
std::string why_not_steppable(const openvdb::FloatGrid& grid, const TriangleMesh& surface,
                              const LevelSetOptions& options);

} // namespace vdb_shell
