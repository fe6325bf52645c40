// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "mesh/topology.h"

#include <cstdint>
#include <vector>

namespace vdb_shell
{

/// How the triangles would have to be turned so that neighbours across edges of two triangles run
/// through them opposite ways. A *piece* is connected across such edges; in each, as few triangles
/// as possible are turned (of two equal halves, the one without the first triangle).
struct Orientation {
    std::vector<std::uint32_t> piece_of; ///< by triangle; pieces by first triangle
    std::vector<char> turn;              ///< by triangle; none in one-sided pieces
    std::vector<char> one_sided;         ///< by piece: no choice makes all its neighbours agree
};

Orientation consistent_orientation(const EdgeUses& sorted_uses, std::size_t triangle_count);

} // namespace vdb_shell
