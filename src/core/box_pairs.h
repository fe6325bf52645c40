// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <openvdb/Types.h>

#include <array>
#include <cstdint>
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

} // namespace vdb_shell
