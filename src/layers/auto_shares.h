// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdb_shell/shell/prism_shell.h"

#include <vector>

namespace vdb_shell
{

/// Where pillars are cut so that prisms are about as high as their triangles are long: by cut from
/// the skin, then by vertex, as shares of the pillar's length, ascending; 1 where a pillar has run
/// out before. The first layer is kFirstHeight edges high, each further one `grading` times the one
/// before it. As many cuts as the longest pillar has use for, kMostAutoLayers layers at most. Empty
/// where one layer is best everywhere.
std::vector<std::vector<double>> auto_shares(const PrismShell& shell, bool upside_down,
                                             double grading);

} // namespace vdb_shell
