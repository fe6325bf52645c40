// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdb_shell/shell/tessellate.h"

#include <cstdint>

namespace vdb_shell
{

/// The randomised choice of diagonals of Erleben and Dohlmann 2004 ([9] of the paper). Same split
/// for the same seed. Throws GeometryError when it has not become consistent within its bound.
PrismSplit ripple_split(const std::vector<openvdb::Vec3I>& triangles, std::uint64_t seed);

} // namespace vdb_shell
