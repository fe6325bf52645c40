// SPDX-License-Identifier: Apache-2.0

// Takes tets and a value at each of their points, gives a float grid over the voxels whose centres
// lie in a tet (tet_columns.h).

#include "volume/tet_values_grid.h"

#include "volume/tet_columns.h"

namespace vdb_shell
{

openvdb::FloatGrid::Ptr tet_values_grid(const TetMesh& tets, const std::vector<double>& value,
                                        double voxel_size, const char* what,
                                        const StageProgress& progress)
{
    const TetColumns columns = tet_columns(tets, value, voxel_size, what);
    auto grid = openvdb::FloatGrid::create(0.0f);
    grid->setTransform(openvdb::math::Transform::createLinearTransform(voxel_size));
    fill_columns(
        columns, grid->tree(), progress,
        [&](auto& column, const TetJob&, const IndexTet& tet, const TetInColumn& part) {
            // Gathered, so that the choice of an instruction set (core/dispatch.h) is made once for
            // 64 rows: one row is little work beside it.
            std::array<DepthRow, 64> rows;
            std::size_t count = 0;
            const DepthAlongZ along{tet.value.value, tet.value.slope[2], tet.corner[0][2],
                                    columns.range.least, columns.range.most};
            for_rows(column, part,
                     [&](float* values, const TetInColumn::Line& line, int z, int begin, int end) {
                         if (count == rows.size()) {
                             fill_depth_rows(rows.data(), count, along);
                             count = 0;
                         }
                         rows[count++] = {values, line.value, z, begin, end};
                     });
            fill_depth_rows(rows.data(), count, along);
        });
    return grid;
}

} // namespace vdb_shell
