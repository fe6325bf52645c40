// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/stage_progress.h"
#include "growth/grow_state.h"
#include "pose/point_energy.h"
#include "pose/skin_side.h"

#include <cstdint>
#include <vector>

namespace vdb_shell
{

/// Takes points that mending has moved back towards where the skin carries them, as far as the
/// exact tests allow: mending shortens more than it has to, and differently in every frame.
/// `failed` are the vertices that could not stay there. Precondition: a valid state.
void bring_back(const RestShell::Parts& parts, const SkinSide& side,
                const std::vector<std::uint8_t>& failed, growth::GrowState& s,
                const PoseState& state);

/// Moves points around tets that are distorted beyond the bound, and those that are not where they
/// were carried, to less energy (PointEnergy), through valid states only. `state` and `s` have the
/// same places. Adds the rounds to the report. Same bits for any number of threads.
void improve_pose(const RestShell::Parts& parts, const SkinSide& side, const PoseOptions& options,
                  growth::GrowState& s, PoseState& state, PoseReport& report,
                  const StageProgress& progress);

} // namespace vdb_shell
