// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/box_tree.h"
#include "growth/grow_state.h"
#include "vdb_shell/step/line_step.h"

namespace vdb_shell::growth
{

/// What a query of the trees finds, kept from one vertex to the next for its memory.
struct NearTriangles {
    BoxTree::Near inner, outer;
};

/// What the triangles around v meet first, with b_v = x; none where nothing. When an inner contact
/// and an outer one both happen, the order of the tests decides which is named, the same way for
/// all vertices. Exact. Precondition: the inner tree's boxes hold the triangles.
StopReason first_contact(const GrowState& s, int v, const Vec3d& x, NearTriangles& near);

} // namespace vdb_shell::growth
