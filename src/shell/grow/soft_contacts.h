// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "shell/grow/grow_state.h"

namespace vdb_shell::growth
{

/// Scratch of one thread.
struct ContactScratch {
    std::vector<int> near;   ///< triangles: inner f, outer F + f
    std::vector<int> corner; ///< their corners: outer v, inner V + v
};

/// Appends soft bounds on b_v from triangles and corners closer than a share of v's reach. They
/// only steer a move away before it touches; the exact test decides.
void contact_bounds(const GrowState& s, int v, ContactScratch& scratch,
                    std::vector<HalfSpace>& bounds);

} // namespace vdb_shell::growth
