// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/stage_progress.h"
#include "growth/grow_state.h"
#include "vdb_shell/step/directions.h"

#include <cstdint>
#include <vector>

namespace vdb_shell::growth
{

/// Puts the inner points at these lengths, of pillars that are nearly valid together, as prolonged
/// ones are, and mends what is not: inner points of prisms that fail a test are moved (untangle.h),
/// and only what that leaves is shortened, by little the first time and by more each time it fails
/// again; points that have lost much by that go back as far as they can (lengthen_again.h). Leaves
/// a valid shell; may pin. Gives back what each inner point has lost by that, as six times a
/// volume: about what it can win back.
std::vector<double> mend_prolonged(GrowState& s, const Directions& directions,
                                   const std::vector<double>& length,
                                   const StageProgress& progress);

/// Where inner points are moved first: wherever one of the twelve tets of a prism is not positive;
/// where the state's own tests fail; or wherever one of the three chosen tets is not positive after
/// diagonals have been turned, which is for the three-tet test, of a shell whose diagonals are
/// free. The first leaves more room for what comes after, the second moves fewer points, the third
/// loses least.
enum class MendFrom { twelve_tets, failures, chosen_tets };

/// The same where the inner points, rounded to float32, and the pins have been put by the caller.
/// Gives the vertices at which mending began.
std::vector<std::uint8_t> mend_placed(GrowState& s, const StageProgress& progress,
                                      MendFrom from = MendFrom::twelve_tets);

} // namespace vdb_shell::growth
