// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/box_tree.h"

#include "vdb_shell/core/interrupter.h"

#include <openvdb/Types.h>

#include <array>
#include <cstdint>
#include <functional>
#include <vector>

namespace vdb_shell
{

/// The tight box of one triangle, and of each.
FloatBox triangle_box(const std::vector<openvdb::Vec3s>& points, const openvdb::Vec3I& triangle);
std::vector<FloatBox> triangle_boxes(const std::vector<openvdb::Vec3s>& points,
                                     const std::vector<openvdb::Vec3I>& triangles);

/// All pairs i < j of boxes that have a point in common, sorted.
std::vector<std::array<std::uint32_t, 2>> overlapping_pairs(const std::vector<FloatBox>& boxes);

/// Those of them for which keep(i, j) holds, which is called from several threads at a time. The
/// interrupter may be null; it is asked by the calling thread only. Throws Cancelled.
using KeepPair = std::function<bool(std::uint32_t, std::uint32_t)>;
std::vector<std::array<std::uint32_t, 2>> overlapping_pairs(const std::vector<FloatBox>& boxes,
                                                            const KeepPair& keep,
                                                            Interrupter* interrupter = nullptr);

} // namespace vdb_shell
