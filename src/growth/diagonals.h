// SPDX-License-Identifier: Apache-2.0
#pragma once

// Which diagonal each surface edge gets: the order stays acyclic in both prisms, always.

#include "growth/grow_state.h"

namespace vdb_shell::growth
{

/// Longest pillar first, ties by index. Under the twelve-tet test any order is valid; of a shell
/// that does not pass it, some prisms may need another one.
void order_by_length(GrowState& s);

/// Turns diagonals of these faces, which ascend, whose chosen tets are not all positive, as long
/// as that makes fewer tets fail and no prism that was sound. Positions stay. For the three-tet
/// test. Returns the number of flips.
std::size_t flip_to_mend(GrowState& s, const std::vector<int>& faces);

/// One pass that turns diagonals while the sum of the log volumes of the two prisms' tets rises:
/// room for the barrier. Returns the number of flips.
std::size_t flip_for_room(GrowState& s);

/// Turns diagonals while the worst mean ratio of the two prisms rises; positions stay.
std::size_t flip_for_quality(GrowState& s);

} // namespace vdb_shell::growth
