// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "growth/grow_state.h"

namespace vdb_shell::growth
{

/// How the witnesses of other components are found. Both find the same ones.
enum class WitnessSearch {
    trees,     ///< those in a box, where there are many. Precondition: the inner tree's boxes hold
               ///< the inner triangles of other components
    one_by_one ///< all: also where witnesses have moved since the tree was built
};

bool is_witness(const GrowState& s, int v);

/// Would moving b_v to x sweep over another component as a whole, touching nothing? The contact
/// tests see only where the triangles end up.
bool swallows_component(const GrowState& s, int v, const Vec3d& x,
                        WitnessSearch search = WitnessSearch::trees);
/// Does prism f hold another component as a whole? Precondition: its tets are positive.
bool holds_component(const GrowState& s, int f, WitnessSearch search = WitnessSearch::trees);

} // namespace vdb_shell::growth
