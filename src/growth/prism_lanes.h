// SPDX-License-Identifier: Apache-2.0
#pragma once

// The eight of a prism's twelve tets that hold one inner point, four at a time.

#include "core/lanes.h"
#include "growth/grow_state.h"

#include <array>

namespace vdb_shell::growth
{

/// Bases of four tets, by corner and relative to their apex: the apex lies where
/// p.(u x w) is negative if they are positive.
struct Bases {
    DoublePoint p, u, w;
};

/// As PrismTables has them, in an order of their own: those of half 0 belong to the pillars of v,
/// the next vertex, the last and v, those of half 1 to the last, v, the next and v. `apex` stands
/// for the inner point of v, the corner `at`.
VDB_SHELL_LANES_PART void bases_around(const GrowState& s, const FaceCorner& at, const Vec3d& apex,
                                       std::array<Bases, 2>& half)
{
    const int v = s.mesh->corner(at.face, at.local);
    const int next = s.mesh->corner(at.face, (at.local + 1) % 3),
              last = s.mesh->corner(at.face, (at.local + 2) % 3);
    for (std::size_t k = 0; k < 3; ++k) {
        const int axis = static_cast<int>(k);
        const DoubleLanes four =
            DoubleLanes{s.a[v][axis], s.a[next][axis], s.a[last][axis], s.b[next][axis]} -
            apex[axis];
        const DoubleLanes fifth = DoubleLanes{} + (s.b[last][axis] - apex[axis]);
        half[0].p[k] = __builtin_shufflevector(four, fifth, 4, 4, 4, 2);
        half[0].u[k] = __builtin_shufflevector(four, fifth, 3, 3, 1, 1);
        half[0].w[k] = __builtin_shufflevector(four, fifth, 0, 1, 2, 0);
        half[1].p[k] = __builtin_shufflevector(four, fifth, 4, 3, 3, 4);
        half[1].u[k] = __builtin_shufflevector(four, fifth, 3, 0, 1, 1);
        half[1].w[k] = __builtin_shufflevector(four, fifth, 2, 2, 2, 0);
    }
}

} // namespace vdb_shell::growth
