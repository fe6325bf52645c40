// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "growth/grow_state.h"
#include "vdb_shell/step/directions.h"

#include <vector>

namespace vdb_shell::growth
{

/// Pins the vertices that can have no pillar: those of no triangle, of no visible direction, of no
/// length or of a cap of 0. Releases all others, and sets every trust radius to 0.
void pin_unservable(GrowState& s, const Directions& directions, const std::vector<double>& length);

/// Puts the inner points at these lengths along the directions, within the cap. Pins what rounding
/// puts onto its outer point.
void place_pillars(GrowState& s, const Directions& directions, const std::vector<double>& length);

} // namespace vdb_shell::growth
