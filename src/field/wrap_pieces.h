// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/stage_progress.h"
#include "field/winding_grid.h"

#include <vector>

namespace vdb_shell
{

/// Triangles cut for the winding number: the same sum, of which little is near to any point.
std::vector<TriangleCorners> cut_to_sum_up(const std::vector<TriangleCorners>& triangles);

/// The input's triangles by what they are to the solid: whole where all of one is of one kind, in
/// pieces of no more than two voxels elsewhere. All coordinates in voxels.
struct WrapPieces {
    std::vector<TriangleCorners> boundary, sheet;
    double boundary_area = 0, sheet_area = 0, interior_area = 0;
};
WrapPieces sort_pieces(WindingGrid& winding, const StageProgress& progress);

/// Takes all pieces for sheets: what is left when no voxel is inside otherwise.
WrapPieces all_sheets(const std::vector<TriangleCorners>& triangles);

} // namespace vdb_shell
