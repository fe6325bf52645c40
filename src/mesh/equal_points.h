// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <openvdb/Types.h>

#include <cstdint>
#include <vector>

namespace vdb_shell
{

/// For each point the first point that equals it (0 and -0 are equal). Precondition: no coordinate
/// is NaN.
std::vector<std::uint32_t> first_equal_point(const std::vector<openvdb::Vec3s>& points);

} // namespace vdb_shell
