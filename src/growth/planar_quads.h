// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "growth/grow_state.h"
#include "vdb_shell/step/directions.h"

#include <vector>

namespace vdb_shell::growth
{

/// Directions near these along which the quads of the prisms are as planar as they can be, while
/// inner triangles stay nearly parallel to their outer ones. `length`: about how long pillars are
/// to be; what can be borne of a bent quad goes by it. Directions with no visibility stay.
Directions with_planar_quads(const GrowState& s, const Directions& directions,
                             const std::vector<double>& length);

} // namespace vdb_shell::growth
