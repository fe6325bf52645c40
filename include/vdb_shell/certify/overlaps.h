// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdb_shell/core/interrupter.h"
#include "vdb_shell/mesh/check_mesh.h"
#include "vdb_shell/shell/tessellate.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace vdb_shell
{

using TetPair = std::array<std::uint32_t, 2>;    ///< two tets, smaller index first
using PrismIndex = std::array<std::uint32_t, 2>; ///< triangle and layer

/// What can be said tet by tet where the whole is not certified: which tets overlap, and which are
/// sound by themselves. A tet is certified when it is positive and its interior has no point in
/// common with any other tet, flat ones aside; a prism when all its tets are. All decided exactly
/// on the float32 coordinates (docs/theory.md, "A surface that crosses itself"). Nothing is said
/// of how certified tets touch: that is what conformity and the certificate of the whole are for.
struct Overlaps {
    std::size_t tets = 0;
    std::size_t prisms = 0;                ///< those with at least one tet
    Defect<TetPair> pairs;                 ///< tets whose interiors have a common point
    Defect<std::uint32_t> uncertified;     ///< tets that are not positive or in a pair
    Defect<PrismIndex> uncertified_prisms; ///< prisms of those tets
    double certified_volume = 0;           ///< of the certified tets: space covered exactly once
    std::vector<std::uint8_t> certified;   ///< by tet: 1 or 0

    std::size_t certified_tets() const { return tets - uncertified.count; }
    std::size_t certified_prisms() const { return prisms - uncertified_prisms.count; }
    /// Every tet is certified: none inverted or flat, no two overlapping.
    bool none() const { return uncertified.count == 0; }
    /// Counts and first indices, one line.
    std::string summary() const;
};

/// Works on any tets with finite points; inverted ones overlap others as sets of points. Flat ones
/// have no interior: they are in no pair, and not certified. Same result for any number of threads.
/// O(n log n) and the number of pairs whose bounding boxes overlap; only overlapping tets are kept.
/// Throws Cancelled.
Overlaps find_overlaps(const TetMesh& tets, Interrupter* interrupter = nullptr);

} // namespace vdb_shell
