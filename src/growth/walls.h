// SPDX-License-Identifier: Apache-2.0
#pragma once

// Planes that keep the triangles of the shell apart while its vertices move.

#include "growth/grow_state.h"

namespace vdb_shell::growth
{

/// A vertex stays where value > 0, and whatever is on the other side stays where it is < 0: two
/// triangles with a wall between them cannot touch, however their corners move.
struct Wall {
    Vec3s n; ///< unit length to float32
    double d;
    double value(const Vec3d& x) const { return n[0] * x[0] + n[1] * x[1] + n[2] * x[2] - d; }
};

/// What a wall stands between. Its d stays within bounds: beyond them it would come within reach of
/// a corner whose vertex does not have it.
struct WallPlace {
    int f,
        g; ///< faces: inner triangle f lies where value > 0; g: -1 if the other one does not move
    double least_d, most_d;
};

/// What is known of each face while walls are raised; kept for the next time, for the outer ones
/// never move and the memory is there.
struct FaceStock {
    std::vector<Corners> corner, outer;
    std::vector<Vec3d> normal, outer_normal; ///< unit length, or zero where there is none
    std::vector<double> reach;               ///< the longest of a face's corners
    std::vector<FloatBox> box;
    std::vector<std::uint8_t> still; ///< none of its corners will move
};

/// Of one GrowState.
struct Walls {
    std::vector<Wall> wall;
    std::vector<WallPlace> place;    ///< of each wall
    std::vector<std::size_t> first;  ///< vertex -> its first side; one past the end
    std::vector<std::uint32_t> side; ///< of all vertices: twice the wall, one more where value < 0
    std::vector<std::uint8_t>
        locked;       ///< by vertex: must not move, something is too near for a wall
    double slack = 0; ///< bound on the rounding error of Wall::value
    FaceStock stock;
};

/// Calls visit(wall) for each wall of vertex v, turned so that v stays where its value is > 0,
/// until one returns false; whether none did.
template <class Visit> bool all_walls_of(const Walls& w, int v, Visit&& visit)
{
    for (std::size_t i = w.first[v]; i < w.first[v + 1]; ++i) {
        if (!visit(w.wall[w.side[i] / 2], w.side[i] % 2 == 0 ? 1.0 : -1.0))
            return false;
    }
    return true;
}

/// The tree of inner triangles is built anew, or kept from before if there is one and only its
/// boxes made anew: sooner, and as good as long as the triangles have not gone far.
enum class Tree { anew, kept };

/// Raises a wall between each inner triangle and every other triangle, inner or outer, that it
/// could meet while each vertex stays within `reach` of where it is now, which becomes its home;
/// triangles with a corner in common have none (kin_clear_at). Vertices marked `still` will not
/// move. The wall stands across the closest points: halfway between two inner triangles, against
/// the outer one or one that is still. Each vertex gets the walls that it could reach.
/// Same walls for any number of threads.
void raise_walls(GrowState& s, const std::vector<std::uint8_t>& still, Walls& w,
                 Tree tree = Tree::anew);

/// Moves each wall between two triangles that move halfway between where these are now, as far as
/// its bounds allow: what one of them has left of its half serves both. Raised anew it would also
/// be turned, which costs far more. Precondition: since the walls were raised every vertex has
/// stayed between its own and within its reach. The walls keep apart what they kept apart before.
void recentre_walls(const GrowState& s, Walls& w);

/// On the right side of all its walls, for certain.
inline bool between_walls(const Walls& w, int v, const Vec3d& x)
{
    return all_walls_of(
        w, v, [&](const Wall& wall, double sign) { return sign * wall.value(x) > w.slack; });
}

} // namespace vdb_shell::growth
