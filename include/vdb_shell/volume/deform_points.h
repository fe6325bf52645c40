// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdb_shell/volume/deform_volume.h"
#include "vdb_shell/volume/shell_map.h"

namespace vdb_shell
{

/// Points and particles of a shell at rest (an OpenVDB points::PointDataGrid) carried to the shell
/// in a pose. Each keeps its place in the shell, its other attributes and its groups; voxel size
/// and transform stay. Attribute "v" (velocity) is turned and stretched with what it is in, "N"
/// goes with normals and keeps length 1; by DeformOptions::vectors other than by_type both do that.
/// With `posed` equal to `rest` positions stay, up to rounding of the places in the shell (some
/// ten-millionths of a prism's size). Same bits for any number of threads.
///
/// `velocity`: how fast the pose moves, a shell of the same tets with velocities in the place of
/// points (velocity_map); what is at a point is added to its "v", which is made where there is
/// none. Null: nothing is added. `shift` is added to the shells' coordinates to get the points'.
///
/// `figures`: active_before and active_after count points, outside is the share of points that no
/// tet holds, which are left out.
///
/// Preconditions: as deform_volume. Throws InvalidOption for options out of range, and, naming the
/// grid, for one that is not of points, has none, has a transform that is not linear or leaves with
/// different attributes or with positions that are not "P" of three floats, and for more points
/// outside than DeformOptions::most_outside; Cancelled.
GridBasePtr deform_points(const openvdb::GridBase& source, const ShellMap& rest,
                          const ShellMap& posed, const openvdb::Vec3d& shift,
                          const DeformOptions& options, DeformFigures& figures,
                          const ShellMap* velocity = nullptr, Interrupter* interrupter = nullptr);

/// Whether the grid is one of points.
bool is_point_grid(const openvdb::GridBase& grid);

} // namespace vdb_shell
