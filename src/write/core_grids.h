// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/point_grid_instances.h"
#include "vdb_shell/shell/core_tets.h"
#include "vdb_shell/write/shell_points.h"

#include <string>

namespace vdb_shell
{

inline constexpr const char* kCorePointsGrid = "core_points";
inline constexpr const char* kCoreTetsGrid = "core_tets";

/// Of a posed shell the exact positions, which `rest` has where a shell is not posed.
inline constexpr const char* kPosition = "position";
inline const char* position_attribute(bool posed)
{
    return posed ? kPosition : "rest";
}

/// What fills the shell, as two grids of points. Corners of tets are ids of the shell's points, and
/// behind those ids the core's own points. `rest`: of a posed shell, where the core's points were.
/// Precondition: require_consistent, of both.
struct CoreGrids {
    openvdb::points::PointDataGrid::Ptr points, tets;
};
CoreGrids make_core_grids(const ShellPoints& points, const TetMesh& tets, const CoreTets& core,
                          const RestPoints& rest = {});

/// Throws ReadError, its message opened by `name`, unless every id is there once and in range.
/// `shell` are the shell's points by id.
CoreTets read_core_grids(const CoreGrids& grids, const ShellCounts& counts,
                         const ShellPoints& shell, const std::string& name);

} // namespace vdb_shell
