// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/stage_progress.h"
#include "pose/point_energy.h"

#include <cstdint>
#include <vector>

namespace vdb_shell
{

/// Moves the free points that `may_move`, each towards the minimum of its PointEnergy. Points whose
/// tets are all below the bound stay. Contacts are nothing to it. Gives the number of rounds. Same
/// bits for any number of threads.
int relax_pose(const RestShell::Parts& parts, PoseState& state, double most_distortion,
               const std::vector<std::uint8_t>& may_move, const StageProgress& progress);

} // namespace vdb_shell
