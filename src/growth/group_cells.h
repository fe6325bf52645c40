// SPDX-License-Identifier: Apache-2.0
#pragma once

// Which groups can be moved at the same time: those that lie in cells far from each other.

#include "growth/box.h"

#include <cstddef>
#include <vector>

namespace vdb_shell::growth
{

/// Groups that are moved one after another, and the box that they keep within while groups of other
/// cells move.
struct GroupCell {
    Box domain;
    std::vector<std::size_t> groups; ///< ascending
};

/// The cells of one turn have domains without a common point.
using GroupTurn = std::vector<GroupCell>;

/// Puts each group into a cell whose domain holds its box with room to spare. Cells are cubes of a
/// few times the size of the groups in them, by powers of two, so that large groups have large
/// ones; the cubes of one size take turns in eight colours. The result depends on the boxes alone.
std::vector<GroupTurn> turns_of_groups(const std::vector<Box>& boxes);

} // namespace vdb_shell::growth
