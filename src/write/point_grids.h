// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/point_grid_instances.h"
#include "vdb_shell/write/shell_points.h"
#include "write/core_grids.h"

#include <string>

namespace vdb_shell
{

inline constexpr const char* kPointsGrid = "shell_points";
inline constexpr const char* kPrismsGrid = "shell_prisms";
inline constexpr const char* kTetsGrid = "shell_tets";

/// Only where there are layers above and below the skin: why the pillars above it end.
inline constexpr const char* kOuterStop = "stop_reason_outer";

/// The shell as three grids of points; the order of points inside a grid means nothing, ids are
/// explicit. Precondition: require_consistent.
struct PointGrids {
    openvdb::points::PointDataGrid::Ptr points, prisms, tets;
};
/// `feet`: by vertex, or empty.
PointGrids make_point_grids(const ShellStack& stack, const TetMesh& tets,
                            const std::vector<CoreFoot>& feet = {}, const RestPoints& rest = {});

/// Fills everything but the splits' ripples. Throws ReadError, its message opened by `name`, unless
/// every id is there once, in range, and the redundant parts agree.
void read_point_grids(const PointGrids& grids, const ShellCounts& counts, const std::string& name,
                      ShellStack& stack, TetMesh& tets);

/// Precondition: the grids are of a posed shell, and have been read into `stack`. Throws ReadError.
RestPoints read_rest_points(const PointGrids& grids, const CoreGrids& core,
                            const ShellCounts& counts, const ShellStack& stack,
                            const std::string& name);

/// Not equality of values: zeros of either sign differ, as they do for the checksum.
bool same_bits(const openvdb::Vec3s& a, const openvdb::Vec3s& b);

} // namespace vdb_shell
