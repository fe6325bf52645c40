// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/grid_instances.h"
#include "core/stage_progress.h"
#include "field/winding_number.h"

#include <cstddef>
#include <utility>
#include <vector>

namespace vdb_shell
{

/// Triangles cut for the winding number: the same sum, of which little is near to any point.
std::vector<TriangleCorners> cut_to_sum_up(const std::vector<TriangleCorners>& triangles);

/// The winding number of triangles at voxels, each computed once.
class WindingGrid
{
public:
    explicit WindingGrid(std::vector<TriangleCorners> triangles) : number_(std::move(triangles)) {}

    const WindingNumber& number() const { return number_; }
    std::vector<float> at(const std::vector<openvdb::Coord>& voxels);

private:
    WindingNumber number_;
    openvdb::FloatGrid turns_;
};

/// The input's triangles by what they are to the solid: whole where all of one is a sheet, in
/// pieces of no more than two voxels elsewhere. All coordinates in voxels.
struct WrapPieces {
    std::vector<TriangleCorners> boundary, sheet;
    double boundary_area = 0, sheet_area = 0, interior_area = 0;
};
WrapPieces sort_pieces(WindingGrid& winding, const StageProgress& progress);

/// Takes all pieces for sheets: what is left when no voxel is inside otherwise.
WrapPieces all_sheets(const std::vector<TriangleCorners>& triangles);

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
