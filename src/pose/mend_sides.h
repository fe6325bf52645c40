// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/stage_progress.h"
#include "pose/skin_crossings.h"

namespace vdb_shell
{

/// Whether mend_sides can make the shell valid: it is not tapered and nothing fills it.
bool can_mend_sides(const RestShell::Parts& parts);

/// Makes a nearly valid pose of an untapered shell valid by the means of growth: prisms that fail
/// the exact tests are moved, and shortened where that does not help (growth/mend_prolonged.h).
/// Where the skin crosses itself contacts are not tested. Surfaces in between are put at the same
/// shares of the pillars as at rest. A pillar that growth gives up stays as it is in `state`, and
/// is counted. Precondition: can_mend_sides(parts).
void mend_sides(const RestShell::Parts& parts, PoseState& state,
                const std::vector<openvdb::Vec3s>& skin, const SkinCrossings& crossings,
                const PoseOptions& options, PoseReport& report, const StageProgress& progress);

} // namespace vdb_shell
