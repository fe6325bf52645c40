// SPDX-License-Identifier: Apache-2.0
#pragma once

// The eight of a prism's twelve tets that hold one inner point, four at a time.

#include "core/simd.h"

#include <array>
#include <cstddef>

namespace vdb_shell::growth
{

/// The corners of a prism but for the inner point of the vertex in question: that vertex's
/// outer point, the outer points of the next and the last in its triangle, and their inner ones.
/// Three doubles each.
struct PrismAround {
    const double *outer, *outer_next, *outer_last, *inner_next, *inner_last;
};

/// Whether doubles show for certain that all tets of the prism that hold the inner point are
/// positive with it at x, those of dropped pillars too: exact::orient3d_filter of each.
bool surely_positive(const PrismAround& prism, const double* x);

/// The bounds of half the tets of one prism, lane by lane: n.(x - here) + value, unit n. A tet that
/// does not count has n = 0 and a value that is always enough.
struct alignas(kLanesAlignment) TetBounds {
    std::array<double, kDoubleLanes> x, y, z, value;
};

/// A prism, and 0 for each of next and last whose pillar is dropped, 1 else.
struct CountedPrism {
    PrismAround prism;
    double of_next, of_last;
};
/// The bounds of each prism's tets that hold the inner point, which is `here`: two halves a prism.
/// Gives back the least value of one.
double bound_tets(const CountedPrism* prisms, std::size_t count, const double* here,
                  TetBounds* bounds);

/// Of half the squares of what the bounds are short of `room` at x: the direction of descent x, y,
/// z (minus the gradient), and the curvature xx, xy, xz, yy, yz, zz.
using ShortfallSlopes = std::array<double, 9>;
ShortfallSlopes sum_shortfalls(const TetBounds* bounds, std::size_t count, double room,
                               const double* x);

} // namespace vdb_shell::growth
