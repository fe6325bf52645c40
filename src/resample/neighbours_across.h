// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <openvdb/Types.h>

#include <array>
#include <cstdint>
#include <limits>
#include <vector>

namespace vdb_shell
{

constexpr std::uint32_t kNoNeighbour = std::numeric_limits<std::uint32_t>::max();

/// The triangle on the other side of each side of a triangle (side i: corner i to corner i + 1),
/// or kNoNeighbour where there is none or more than one, or where it runs through the side the same
/// way.
using NeighboursAcross = std::array<std::uint32_t, 3>;

std::vector<NeighboursAcross> neighbours_across(const std::vector<openvdb::Vec3I>& triangles);

} // namespace vdb_shell
