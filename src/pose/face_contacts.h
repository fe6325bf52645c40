// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pose/rest_parts.h"
#include "pose/skin_crossings.h"

#include <openvdb/Types.h>

#include <array>
#include <cstdint>
#include <vector>

namespace vdb_shell
{

using FacePair = std::array<std::uint32_t, 2>;

/// Pairs of free faces (RestShell::Parts::free), one of them no outer triangle, that are not apart:
/// they touch in more than common corners and edges, or share an edge and have tets behind them
/// that overlap, so that one has been turned past the other. Where the skin crosses itself none is
/// told. Exact; same order for any number of threads. `points` are those of the tets.
std::vector<FacePair> faces_not_apart(const RestShell::Parts& parts,
                                      const std::vector<openvdb::Vec3s>& points,
                                      const std::vector<openvdb::Vec3s>& skin,
                                      const SkinCrossings& crossings);

} // namespace vdb_shell
