// SPDX-License-Identifier: Apache-2.0
#pragma once

// Planes that keep the triangles of the shell apart while its vertices move.

#include "shell/grow/grow_state.h"

namespace vdb_shell::growth
{

/// A vertex stays where value > 0, and whatever is on the other side stays where it is < 0: two
/// triangles with a wall between them cannot touch, however their corners move.
struct Wall {
    Vec3s n; ///< unit length to float32
    double d;
    double value(const Vec3d& x) const { return n[0] * x[0] + n[1] * x[1] + n[2] * x[2] - d; }
};

struct Walls {
    std::vector<std::size_t> first; ///< vertex -> its first wall; one past the end
    std::vector<Wall> wall;         ///< of all vertices
    std::vector<std::uint8_t>
        locked;       ///< by vertex: must not move, something is too near for a wall
    double slack = 0; ///< bound on the rounding error of Wall::value
};

inline Slice<Wall> walls_of(const Walls& w, int v)
{
    return {w.wall.data() + w.first[v], w.wall.data() + w.first[v + 1]};
}

/// Raises a wall between each inner triangle and every other triangle, inner or outer, that it
/// could meet while each vertex stays within `reach` of where it is now, which becomes its home;
/// triangles with a corner in common have none (kin_clear_at). Vertices marked `still` will not
/// move. The wall stands across the closest points: halfway between two inner triangles, against
/// the outer one or one that is still. Each vertex gets the walls that it could reach.
/// Same walls for any number of threads.
void raise_walls(GrowState& s, const std::vector<std::uint8_t>& still, Walls& w);

/// On the right side of all its walls, for certain.
inline bool between_walls(const Walls& w, int v, const Vec3d& x)
{
    for (const Wall& wall : walls_of(w, v))
        if (!(wall.value(x) > w.slack))
            return false;
    return true;
}

} // namespace vdb_shell::growth
