// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdb_shell/mesh/triangle_mesh.h"
#include "vdb_shell/shell/tessellate.h"

#include <array>
#include <atomic>
#include <cstdint>
#include <vector>

namespace vdb_shell
{

struct SamplePoint {
    openvdb::Vec3s position;
    std::uint32_t cell;
    bool in_solid;
};

/// Tets with what is computed of them once.
struct SignedTets {
    const TetMesh& mesh;
    Bounds bounds;                 ///< of the tets and of all points that are tested
    double span = 0;               ///< diagonal of the bounds
    std::vector<std::int8_t> sign; ///< exact; flat tets have 0 and no inside
};
SignedTets signed_tets(const TetMesh& tets, const Bounds& bounds);

struct TetBox {
    openvdb::Vec3s low, high;
};
TetBox box_of(const std::array<openvdb::Vec3s, 4>& corners);

/// In how many tets each point lies, as far as it matters. Counts only grow, by integers, and a
/// point is skipped only once more would change nothing that is reported of it. So whether a count
/// ends as 0, as 1 or as more is the same in whatever order threads come to the tets; the exact
/// number of several is not.
std::vector<std::atomic<std::uint32_t>> count_tets(const SignedTets& tets,
                                                   const std::vector<SamplePoint>& points);

} // namespace vdb_shell
