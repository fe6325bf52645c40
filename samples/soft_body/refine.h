// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "solid.h"

namespace soft_body
{

/// Each tet in eight: its edges are halved, and the octahedron in its middle is cut at its shortest
/// diagonal. Layers are not kept.
struct Refined {
    Solid solid;                             ///< its first points are those of the coarse one
    std::vector<std::array<int, 2>> parents; ///< of each further point: the ends of its edge
};
Refined refine(const Solid& solid);

} // namespace soft_body
