// SPDX-License-Identifier: Apache-2.0

#include "volume/tet_index_grid.h"

#include "core/fail.h"
#include "vdb_shell/core/error.h"

#include <limits>

namespace vdb_shell
{

openvdb::Int32Grid::Ptr tet_index_grid(const TetMesh& tets, const VoxelLattice& lattice,
                                       const char* name, const StageProgress& progress,
                                       const std::vector<std::uint8_t>& wanted)
{
    // Grids of whole numbers have 32 bits and a sign, which says that there is none.
    if (tets.tets.size() > std::size_t(std::numeric_limits<std::int32_t>::max()))
        fail<InvalidOption>(name, ": ", tets.tets.size(), " tets, over the limit of 2^31 - 1");
    const TetColumns columns = tet_columns(tets, {}, lattice, name, wanted);
    auto grid = openvdb::Int32Grid::create(-1);
    grid->setTransform(transform_of(lattice));
    fill_columns(
        columns, grid->tree(), progress,
        [](auto& column, const TetJob& job, const IndexTet&, const TetInColumn& part) {
            for_rows(column, part,
                     [&](std::int32_t* values, const TetInColumn::Line&, int, int begin, int end) {
                         // Later tets are written over earlier ones. for_rows is called with the
                         // greatest index first, so the smallest stays.
                         std::fill(values + begin, values + end, std::int32_t(job.tet));
                     });
        });
    return grid;
}

} // namespace vdb_shell
