// SPDX-License-Identifier: Apache-2.0
#pragma once

// Which diagonal each surface edge gets: the order stays acyclic in both prisms, always.

#include "growth/grow_state.h"

namespace vdb_shell::growth
{

/// Longest pillar first, ties by index. Precondition: the twelve-tet test holds, under which any
/// order is valid.
void order_by_length(GrowState& s);

/// One pass that turns diagonals while the sum of the log volumes of the two prisms' tets rises:
/// room for the barrier. Returns the number of flips.
std::size_t flip_for_room(GrowState& s);

/// Turns diagonals while the worst mean ratio of the two prisms rises; positions stay.
std::size_t flip_for_quality(GrowState& s);

} // namespace vdb_shell::growth
