// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/stage_progress.h"
#include "pose/point_energy.h"

#include <cstdint>
#include <functional>
#include <vector>

namespace vdb_shell
{

/// Numbers of the inverted tets of the state as it would be stored.
using InvertedTets = std::function<std::vector<std::uint32_t>(const PoseState&)>;

/// Turns inverted tets round where points of several pillars have to move together for that: each
/// point of them, and of the tets beside, that is not `enough` of its spacing away from the planes
/// of all its tets goes to where it is, or as far as can be; again and again. Contacts are not
/// looked at. The state is changed only if fewer tets are inverted in the end. Throws Cancelled.
void centre_points(const RestShell::Parts& parts, PoseState& state, const InvertedTets& inverted,
                   double enough, const StageProgress& progress);

} // namespace vdb_shell
