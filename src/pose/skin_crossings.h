// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pose/point_energy.h"

#include "vdb_shell/core/interrupter.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace vdb_shell
{

/// Where a posed skin crosses itself.
struct SkinCrossings {
    std::size_t pairs = 0; ///< of triangles that cross or touch
    /// By triangle: it crosses another, or the shell below it reaches into another part of the
    /// solid, or one of its neighbours does. Empty where there are no pairs.
    std::vector<std::uint8_t> region;
};

/// `state` has the inner points whose way from the skin is looked at. Same result for any number
/// of threads. Throws Cancelled.
SkinCrossings find_skin_crossings(const RestShell::Parts& parts, const PoseState& state,
                                  const std::vector<openvdb::Vec3s>& skin,
                                  Interrupter* interrupter);

} // namespace vdb_shell
