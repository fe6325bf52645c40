// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/box_pairs.h"
#include "core/pair_bounds.h"

#include <vector>

namespace vdb_shell
{

/// The pairs i < j of triangles for which keep(i, j) holds, sorted, each once, out of some that lie
/// near each other: no pair is missed that has a point in common besides corners and edges that the
/// two share by index. keep is called from several threads at a time, of a pair maybe several
/// times, and has to answer the same. Triangles whose flag in `left_out` is set are in no pair;
/// none may be said. The interrupter may be null. Throws Cancelled.
std::vector<std::array<std::uint32_t, 2>>
overlapping_triangles(const std::vector<openvdb::Vec3s>& points,
                      const std::vector<openvdb::Vec3I>& triangles, const KeepPair& keep,
                      Interrupter* interrupter = nullptr, const std::vector<char>& left_out = {});

struct FoundPairs {
    std::vector<std::array<std::uint32_t, 2>> pairs;
    bool all = true; ///< false: there were more than were wanted
};
/// The same as far as they are wanted.
FoundPairs overlapping_triangles(const std::vector<openvdb::Vec3s>& points,
                                 const std::vector<openvdb::Vec3I>& triangles, const KeepPair& keep,
                                 const PairBounds& wanted, Interrupter* interrupter = nullptr,
                                 const std::vector<char>& left_out = {});

} // namespace vdb_shell
