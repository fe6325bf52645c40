// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "field/wrap_pieces.h"

#include <cstddef>

namespace vdb_shell
{

/// The field whose zero surface is the wrap: negative inside, in voxels, near the zero surface of
/// the pieces about a distance. Active wherever it was computed: within three voxels of every
/// piece, and around every change of sign; flood-filled elsewhere. `half_size`: of the triangles'
/// box about the origin, beyond which nothing is solid but what is within `sheet_voxels` of it.
openvdb::FloatGrid::Ptr wrap_field(const WrapPieces& pieces, WindingGrid& winding,
                                   double sheet_voxels, const openvdb::Vec3d& half_size,
                                   const StageProgress& progress);

/// Makes solid what no path from voxel to voxel over their faces leads out of, and what stands in
/// there. The number of active voxels that became solid.
std::size_t fill_voids(openvdb::FloatGrid& field);

} // namespace vdb_shell
