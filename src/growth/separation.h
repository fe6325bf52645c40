// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/simd.h"
#include "growth/predicates.h"

#include <cstddef>
#include <limits>

namespace vdb_shell::growth
{

/// The room between two triangles across a direction: the first lies where n.(x - origin) >= lo,
/// the second where it is <= hi, with origin the first one's first corner.
struct Slab {
    Vec3s n{0.0f}; ///< unit length to float32
    double lo = 0, hi = 0;
    double gap = -std::numeric_limits<double>::max(); ///< lo - hi
};

/// Two triangles, and how wide a slab between them need be.
struct SlabQuery {
    const Corners *first, *second;
    double enough;
};

/// How many queries cost as much as one.
inline constexpr std::size_t kSlabsAtOnce = kLanes;

/// The widest slab between the two triangles of each query, but for rounding: across the direction
/// between their closest points. Where it is seen to be wider than enough, only the gap is given,
/// as infinite. gap <= 0 where the triangles touch, or nearly so. Each slab depends on its own
/// query alone. Precondition: count <= kSlabsAtOnce.
void slabs_between(const SlabQuery* query, std::size_t count, Slab* slab);

} // namespace vdb_shell::growth
