// SPDX-License-Identifier: Apache-2.0
#pragma once

// Inner points moved until the tets of their prisms are positive.

#include "growth/grow_state.h"

#include <cstdint>
#include <vector>

namespace vdb_shell::growth
{

/// Which tets of a prism are to become positive: all twelve, or those of its present split.
enum class UntangledTets { twelve, chosen };

/// Moves b of the vertices marked in `look`, and of those that this draws in, until these tets of
/// each prism around them are positive or `sweeps` have gone by: by as little as puts their
/// bounds right, in least squares, and along the inner surface rather than across it. Pinned
/// vertices stay, the cap is kept; contacts are nothing to it. Leaves in `look` what would be
/// looked at next, and marks in `moved` what has moved. Same bits for any number of threads.
void untangle(GrowState& s, int sweeps, std::vector<std::uint8_t>& look,
              std::vector<std::uint8_t>& moved, UntangledTets tets);

} // namespace vdb_shell::growth
