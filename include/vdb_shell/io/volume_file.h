// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdb_shell/core/grid_types.h"

#include <filesystem>
#include <string>
#include <vector>

namespace vdb_shell
{
class OutputSet;

enum class GridKinds { volumes, volumes_and_points };

/// Whether read_volumes reads it. Its metadata are enough.
bool is_volume(const openvdb::GridBase& grid, GridKinds kinds);

/// The volumes of a .vdb in the order of their names: grids of floats (half floats too), of vectors
/// of three floats and of 32-bit whole numbers; and where `kinds` say so those of points. `names`:
/// only these, in this order; empty: all that the file has, leaving out grids of other types.
/// Nothing is decoded before require_whole_vdb has passed the file. Throws ReadError, with the
/// grids that the file has, for a name that is not there, of another type or of several
/// grids, and where there is nothing of these kinds.
std::vector<GridBasePtr> read_volumes(const std::filesystem::path& path,
                                      const std::vector<std::string>& names = {},
                                      GridKinds kinds = GridKinds::volumes);

/// Writes grids with their names, types and transforms, and this program as their creator. Same
/// bytes for the same grids: where OpenVDB draws a random UUID stands a digest of the file. Throws
/// InvalidOption for two grids of one name, WriteError. Precondition: no grid is null, and none is
/// without a name.
void write_volumes(const std::filesystem::path& path, const std::vector<GridBasePtr>& grids,
                   OutputSet* with = nullptr);

} // namespace vdb_shell
