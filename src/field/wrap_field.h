// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/grid_instances.h"
#include "core/stage_progress.h"
#include "field/winding_number.h"

#include <vector>

namespace vdb_shell
{

/// The input's triangles in pieces of no more than two voxels, by what they are to the solid. All
/// coordinates in voxels.
struct WrapPieces {
    std::vector<TriangleCorners> boundary, sheet;
    double boundary_area = 0, sheet_area = 0, interior_area = 0;
};
WrapPieces sort_pieces(const WindingNumber& winding, const StageProgress& progress);

/// Takes all pieces for sheets: what is left when no voxel is inside otherwise.
WrapPieces all_sheets(const std::vector<TriangleCorners>& triangles);

/// The field whose zero surface is the wrap: negative inside, in voxels, near the zero surface of
/// the pieces about a distance. Active wherever it was computed: within three voxels of every
/// piece, and around every change of sign; flood-filled elsewhere.
openvdb::FloatGrid::Ptr wrap_field(const WrapPieces& pieces, const WindingNumber& winding,
                                   double sheet_voxels, const StageProgress& progress);

} // namespace vdb_shell
