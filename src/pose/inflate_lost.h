// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/stage_progress.h"
#include "growth/grow_state.h"
#include "vdb_shell/mesh/triangle_mesh.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace vdb_shell
{

/// Vertices whose pillar growth gave up, ascending: pinned, although their cap allows a length.
std::vector<int> lost_vertices(const growth::GrowState& s);

/// Gives lost pillars a length again. The pillars around them are shrunk until a tiny one fits
/// between, which in exact arithmetic always comes to pass where the skin leaves the vertex a
/// direction (docs/theory.md, "Posed shells"); then all of these are inflated together until they
/// outlast the rounding to float32, and pass the tests of growth. What stays lost is pinned.
/// `s.twelve` is left as it was. Precondition: a valid state on `mesh`, as growth/mend_prolonged.h
/// leaves it. Returns how many of those that stay lost the skin demands (mesh/most_visible.h).
std::size_t inflate_lost(growth::GrowState& s, const TriangleMesh& mesh,
                         const StageProgress& progress);

} // namespace vdb_shell
