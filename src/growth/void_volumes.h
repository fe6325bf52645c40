// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdb_shell/shell/prism_shell.h"

#include <vector>

namespace vdb_shell
{

/// Per triangle, an estimate of the void under its prism: the volume between the inner triangle and
/// half the way to the next inner triangle that a ray against its normal leaves through, on
/// average over rays from kPiecesAlong^2 even places of the triangle. Their sum is the volume that
/// the inner surface encloses where the void is thin; where it is fat they overlap. Pinned prisms
/// hold all of the solid under them.
std::vector<double> void_volumes(const PrismShell& shell);

} // namespace vdb_shell
