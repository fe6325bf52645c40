// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdb_shell/core/grid_types.h"
#include "vdb_shell/core/interrupter.h"
#include "vdb_shell/field/level_set.h"
#include "vdb_shell/mesh/triangle_mesh.h"
#include "vdb_shell/options/name_table.h"

namespace vdb_shell
{

/// Where the lines' field is computed.
enum class FieldRoute {
    automatic, ///< sparse where it is right and less work
    sparse,    ///< sparse where it is right
    dense,     ///< all voxels down to the depth of the lines: mesh_to_level_set
};
const NameTable<FieldRoute>& names(FieldRoute);

/// The signed distance to a closed mesh within options.exterior_voxels of it on either side, as
/// mesh_to_level_set names and places it, background likewise; depths in the options are not read.
/// Each value is the distance in doubles to the nearest triangle, rounded once; its sign is that of
/// the angle-weighted pseudo-normal there, so cavities need nothing special.
/// Preconditions: closed, every edge of two triangles, oriented (cavities inward), no
/// self-intersections; else signs are wrong. Throws as mesh_to_level_set does. Same bits for any
/// number of threads.
FloatGridPtr mesh_to_narrow_band(const TriangleMesh& mesh, const LevelSetOptions& options,
                                 Interrupter* interrupter = nullptr);

} // namespace vdb_shell
