// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <openvdb/Types.h>

#include <array>
#include <cstdint>
#include <functional>
#include <vector>

namespace vdb_shell
{

struct Box {
    openvdb::Vec3s low, high;
};

/// The tight box of each triangle.
std::vector<Box> triangle_boxes(const std::vector<openvdb::Vec3s>& points,
                                const std::vector<openvdb::Vec3I>& triangles);

/// All pairs i < j of boxes that have a point in common, sorted. Embree's collision of two bounding
/// volume hierarchies; the sort makes the result independent of its threads.
std::vector<std::array<std::uint32_t, 2>> overlapping_pairs(const std::vector<Box>& boxes);

/// Those of them for which keep(i, j) holds; for pairs too many to be listed first. Asked from
/// several threads at a time, perhaps twice of one pair; it must not throw.
using KeepPair = std::function<bool(std::uint32_t, std::uint32_t)>;
std::vector<std::array<std::uint32_t, 2>> overlapping_pairs(const std::vector<Box>& boxes,
                                                            const KeepPair& keep);

} // namespace vdb_shell
