// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "shell/grow/predicates.h"

#include <limits>

namespace vdb_shell::growth
{

/// A triangle and how far its corners may move.
struct Body {
    Corners corner;
    Vec3d normal; ///< unit length, or zero where the triangle has none
    double reach;
};

Body body_of(const Corners& corner, double reach);

/// The room between two triangles across a direction: the first lies where n.(x - origin) >= lo,
/// the second where it is <= hi, with origin the first one's first corner.
struct Slab {
    Vec3s n{0.0f}; ///< unit length to float32
    double lo = 0, hi = 0;
    double gap = -std::numeric_limits<double>::max(); ///< lo - hi
};

/// The widest slab between two triangles, but for rounding: across the direction between their
/// closest points. Where it is seen to be wider than `enough`, only the gap is given, as infinite.
/// gap <= 0 where the triangles touch, or nearly so.
Slab slab_between(const Body& first, const Body& second, double enough);

} // namespace vdb_shell::growth
