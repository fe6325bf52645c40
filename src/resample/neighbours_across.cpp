// SPDX-License-Identifier: Apache-2.0

// Takes: triangles by their corners. Gives: the neighbour across each side, where there is exactly
// one that is oriented like the triangle.

#include "resample/neighbours_across.h"

#include "mesh/topology.h"

#include <cstddef>

namespace vdb_shell
{

std::vector<NeighboursAcross> neighbours_across(const std::vector<openvdb::Vec3I>& triangles)
{
    std::vector<NeighboursAcross> across(triangles.size(),
                                         {kNoNeighbour, kNoNeighbour, kNoNeighbour});
    const EdgeUses uses = sorted_edge_uses(triangles);
    for (std::size_t begin = 0, end = 0; begin < uses.size(); begin = end) {
        while (end < uses.size() && uses[end].edge == uses[begin].edge)
            ++end;
        if (end - begin != 2 || uses[begin].forward == uses[begin + 1].forward)
            continue;
        const EdgeUse &one = uses[begin], &other = uses[begin + 1];
        across[one.triangle][one.side] = other.triangle;
        across[other.triangle][other.side] = one.triangle;
    }
    return across;
}

} // namespace vdb_shell
