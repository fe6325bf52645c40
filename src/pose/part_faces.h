// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/stage_progress.h"
#include "pose/point_energy.h"
#include "pose/skin_crossings.h"

#include <openvdb/Types.h>

#include <vector>

namespace vdb_shell
{

/// Makes a pose valid that mend_sides is not for, as far as moving its points does: tets that are
/// not positive are mended, and free faces that touch (RestShell::Parts::free) are parted. Where
/// the skin crosses itself contacts are let be. Nothing is promised: the report has what is left.
/// Same bits for any number of threads.
void part_faces(const RestShell::Parts& parts, PoseState& state,
                const std::vector<openvdb::Vec3s>& skin, const SkinCrossings& crossings,
                const PoseOptions& options, PoseReport& report, const StageProgress& progress);

} // namespace vdb_shell
