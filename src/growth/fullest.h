// SPDX-License-Identifier: Apache-2.0
#pragma once

// Which of the shells that growth can come to is taken.

#include "growth/attempts.h"
#include "growth/connectivity.h"
#include "vdb_shell/growth/grow.h"
#include "vdb_shell/shell/prism_shell.h"

#include <cstdint>
#include <functional>
#include <vector>

namespace vdb_shell::growth
{

/// Grows in that way, a restart on from the shell that it is given; others are given none.
using GrowOneWay = std::function<GrowResult(const Attempt&, const GrowResult* restarted)>;

/// The shell of the first attempt, and where that is not full enough the fullest of all; then what
/// growth comes to from that, again and again. `cap` is the bound on each pillar's length.
GrowResult grow_fullest(const GrowStart& start, const Connectivity& connectivity,
                        const std::vector<double>& cap, const GrowOptions& options,
                        const GrowOneWay& grow);

/// By component, whether its inner surface has turned inside out. The tests of moves do not see
/// that: where a component has few triangles, one move may take a vertex past all others, from one
/// embedded surface to another, and with all tets positive on both sides.
std::vector<std::uint8_t> turned_components(const Connectivity& connectivity,
                                            const PrismShell& shell);

} // namespace vdb_shell::growth
