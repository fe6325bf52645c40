// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/parallel.h"
#include "growth/move_tests.h"
#include "growth/walls.h"

namespace vdb_shell::growth
{

/// Everything that a move between walls must satisfy, cheapest test first. No component can be
/// swallowed: on its straight way no triangle passes through a wall.
inline bool move_allowed_between(const GrowState& s, const Walls& w, int v, const Vec3d& x)
{
    return between_walls(w, v, x) && within_cap(s, v, x) && tets_positive_at(s, v, x) &&
           kin_clear_at(s, v, x);
}

/// One Gauss-Seidel sweep over the vertices that are not `still`: propose(v, x) returns true and a
/// position that move_allowed_between allows, which is then taken. The vertices of a colour go in
/// parallel: what one of them reads, walls aside, no other of them moves.
template <class Propose>
void sweep(GrowState& s, const Walls& w, const std::vector<std::uint8_t>& still,
           const Propose& propose)
{
    constexpr std::size_t kGrain = 6; // a proposal costs microseconds
    for (const std::vector<int>& colour : s.mesh->colour)
        for_each_index(
            colour.size(),
            [&](std::size_t i) {
                const int v = colour[i];
                Vec3d x;
                if (!still[v] && !w.locked[v] && propose(v, x))
                    s.b[v] = x;
            },
            kGrain);
}

} // namespace vdb_shell::growth
