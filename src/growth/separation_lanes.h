// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/simd.h"

#include <array>

// Pairs of triangles, a pair to a lane: how far apart they are, and across which direction.

namespace vdb_shell::growth
{

/// A point or a direction to a lane, by axis.
struct alignas(kLanesAlignment) PointRow {
    std::array<std::array<double, kLanes>, 3> at;
};

/// The corners of the pairs: those of the first triangles, then of the second, relative to corner 0
/// of the first.
struct alignas(kLanesAlignment) PairLanes {
    std::array<PointRow, 6> corner;
    std::array<float, kLanes> enough; ///< of the room between the two
};

/// What floats show of each pair. Rooms are in the corners' unit.
struct PairEstimates {
    unsigned wide = 0;  ///< a bit a lane: certainly wider than enough
    unsigned close = 0; ///< edges so close that floats cannot choose
    /// 3 i + j for the closest, i of the first and j of the second
    std::array<float, kLanes> edges;
    std::array<float, kLanes> across_middles, across_first, across_second;
};
void estimate_rooms(const PairLanes& pairs, PairEstimates& estimates);

/// Edges from p and from q to their ends.
struct EdgeRows {
    const PointRow &p, &p_end, &q, &q_end;
};
/// From the closest point of each first edge to that of the second (Ericson 2005, "Real-Time
/// Collision Detection", 5.1.9).
void between_edges(const EdgeRows& edges, PointRow& between);

/// The slabs of the pairs across a direction each, and that one's length, squared.
struct alignas(kLanesAlignment) SlabLanes {
    std::array<std::array<float, kLanes>, 3> n;
    std::array<double, kLanes> lo, hi, gap, squared;
};
void slabs_across(const PairLanes& pairs, const PointRow& ways, SlabLanes& slabs);

} // namespace vdb_shell::growth
