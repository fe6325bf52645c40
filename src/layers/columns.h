// SPDX-License-Identifier: Apache-2.0
#pragma once

// The pillars of a shell cut into layers, and what makes the tets of the layers positive again
// where cutting and rounding spoiled them.

#include "core/stage_progress.h"
#include "mesh/topology.h"
#include "vdb_shell/shell/prism_test.h"
#include "vdb_shell/shell/tessellate.h"

#include <cstdint>
#include <vector>

namespace vdb_shell
{

struct Columns {
    const std::vector<openvdb::Vec3I>* triangles = nullptr;
    std::vector<std::vector<openvdb::Vec3s>> surface; ///< from the skin to the far end
    bool upside_down = false;                         ///< the skin is the inner surface
    std::vector<std::vector<std::uint8_t>> fixed; ///< points that may not be mended; empty: none
    PrismTest test = PrismTest::twelve_tets;
    std::vector<std::uint8_t> order; ///< per triangle: index into growth::PrismTables
    VertexTriangles around;

    std::size_t layers() const { return surface.size() - 1; }
};

/// Every pillar cut at its shares, by cut and vertex, from the skin, rounded to the nearest floats.
Columns cut_pillars(const PrismShell& shell, const PrismSplit& split,
                    const std::vector<std::vector<double>>& shares, bool upside_down,
                    PrismTest test);

/// Moves points between the layers while that leaves fewer tets that are not positive.
void mend_columns(Columns& columns, const StageProgress& progress);

/// Makes the pillars of prisms that have such a tet after all whole again, and so on from prism to
/// prism, until there is no such tet. Gives back how many pillars became whole. At worst all do,
/// and the shell is the one that was cut.
std::size_t keep_whole_where_bad(Columns& columns);

std::size_t points_that_differ(const std::vector<std::vector<openvdb::Vec3s>>& a,
                               const std::vector<std::vector<openvdb::Vec3s>>& b);

} // namespace vdb_shell
