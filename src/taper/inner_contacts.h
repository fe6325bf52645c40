// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "taper/taper_state.h"

#include <array>
#include <vector>

namespace vdb_shell::taper
{

void build_trees(TaperState& s);
/// After many changes boxes are wider than they have to be.
void rebuild_inner_tree(TaperState& s);
/// Tells the tree where the inner triangles among the pieces are now.
void update_inner_tree(TaperState& s, const std::vector<int>& pieces);

/// Whether the inner triangles among the pieces, as they are now, touch no other triangle in more
/// than what they share, but for one that lies on them and faces them.
bool inner_triangles_clear(const TaperState& s, const std::vector<int>& pieces);

/// What an inner triangle sweeps over when a change takes its moving corners to one place: the tet
/// of its old corners and that place.
struct Swept {
    std::array<int, 3> nodes; ///< of the old triangle
    TetCorners corners;       ///< those of the old triangle, then the place
};
/// Appends those of the inner triangles among the pieces that have node `n`; the place comes later.
void list_swept(const TaperState& s, const std::vector<int>& pieces, int n,
                std::vector<Swept>& swept);
/// Whether the inner surface has been taken past a part of itself: asked after the change, where
/// no triangles touch. `pieces` are those that have changed, `moving` the node that moved or was
/// taken in, and the one that it is part of now.
bool passes_itself(const TaperState& s, const std::vector<Swept>& swept,
                   const std::vector<int>& pieces, const std::array<int, 2>& moving);

} // namespace vdb_shell::taper
