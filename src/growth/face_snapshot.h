// SPDX-License-Identifier: Apache-2.0
#pragma once

// Where the faces stand at the beginning of a round, as the search for close pairs reads them.

#include "growth/grow_state.h"

namespace vdb_shell::growth
{

/// By face. Kept from one round to the next: outer triangles never move, and the memory is there.
/// Without the corners, which are read from the vertices: that takes no longer (four scans of
/// 20,000 to 100,000 triangles), and these are half as many as faces.
struct FaceSnapshot {
    std::vector<Vec3d> normal, outer_normal; ///< unit length, or zero where there is none
    std::vector<double> trust_radius;        ///< the longest of the active corners'
    std::vector<FloatBox> box;               ///< of the inner triangle, wider by trust_radius
    std::vector<std::uint8_t> inactive;      ///< none of its corners will move
};

/// Makes the present place of each vertex the centre of its trust region and describes the faces.
void take_snapshot(GrowState& s, const std::vector<std::uint8_t>& inactive, FaceSnapshot& faces);

} // namespace vdb_shell::growth
