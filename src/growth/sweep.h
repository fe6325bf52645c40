// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/parallel.h"
#include "growth/move_tests.h"
#include "growth/separating_planes.h"

namespace vdb_shell::growth
{

/// Everything that a move between separating planes must satisfy, cheapest test first. No component
/// can be enclosed by it: on its straight way no triangle passes through a plane.
inline bool move_allowed(const GrowState& s, const SeparatingPlanes& planes, int v, const Vec3d& x)
{
    return on_own_sides(planes, v, x) && within_cap(s, v, x) && tets_positive_at(s, v, x) &&
           adjacent_clear_at(s, v, x);
}

/// One Gauss-Seidel sweep over the vertices that are not `inactive`: propose(v, x) returns true and
/// a position that move_allowed allows, which is then taken. The vertices of a colour go in
/// parallel: what one of them reads, planes aside, no other of them moves (docs/theory.md,
/// "Same result for any number of threads").
template <class Propose>
void sweep(GrowState& s, const SeparatingPlanes& planes, const std::vector<std::uint8_t>& inactive,
           const Propose& propose)
{
    constexpr std::size_t kVerticesAtOnce = 6; // a proposal costs microseconds
    for (const std::vector<int>& colour : s.mesh->colour)
        for_each_index(
            colour.size(),
            [&](std::size_t i) {
                const int v = colour[i];
                Vec3d x;
                if (!inactive[v] && !planes.locked[v] && propose(v, x))
                    s.b[v] = x;
            },
            kVerticesAtOnce);
}

} // namespace vdb_shell::growth
