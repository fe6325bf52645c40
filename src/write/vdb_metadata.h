// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/grid_instances.h"
#include "vdb_shell/write/vdb_file.h"

namespace vdb_shell
{

/// The file's metadata: what read_shell_info reads.
openvdb::MetaMap shell_metadata(const std::filesystem::path& path, const ShellFile& file,
                                PointPlacement points);

/// Houdini keeps a grid's metadata, as attributes of its primitive; and of a point grid those named
/// `global:...`, as detail attributes.
void add_volume_metadata(openvdb::GridBase& grid, const openvdb::MetaMap& file);
void add_points_metadata(openvdb::GridBase& grid, const openvdb::MetaMap& file);

/// Throws ReadError for missing entries, wrong types, counts out of range, a newer schema.
ShellInfo info_from_metadata(const openvdb::MetaMap& metadata, const std::filesystem::path& path);

} // namespace vdb_shell
