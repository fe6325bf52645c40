// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "growth/grow_state.h"
#include "vdb_shell/step/line_step.h"

namespace vdb_shell::growth
{

/// What holds each vertex back, tested with one short step along its pillar: thickness, prism,
/// inner_contact, outer_contact, pinned; none where the step would be allowed, and around vertices
/// of thousands of triangles where only the vertex's own way was looked at. Refits the tree
/// of inner triangles.
std::vector<StopReason> probe_stops(GrowState& s);

/// What needs no step: pinned and thickness; not_asked for all others.
std::vector<StopReason> plain_stops(const GrowState& s);

} // namespace vdb_shell::growth
