// SPDX-License-Identifier: Apache-2.0
#pragma once

// Planes that keep the triangles of the shell apart while its vertices move (docs/theory.md,
// "Separating planes").

#include "growth/face_snapshot.h"

namespace vdb_shell::growth
{

/// A vertex stays where value > 0, and whatever is on the other side stays where it is < 0: two
/// triangles with a plane between them cannot touch, however their corners move.
struct SeparatingPlane {
    Vec3s n; ///< unit length to float32
    double d;
    double value(const Vec3d& x) const { return n[0] * x[0] + n[1] * x[1] + n[2] * x[2] - d; }
};

/// The faces that a plane separates, and how far it may be pushed: with d beyond these bounds it
/// would come within the trust radius of a corner whose vertex does not have it on its list.
struct PlaneRange {
    int f, g; ///< inner face f lies where value > 0; g is -1 if the other face does not move
    double least_d, most_d;
};

/// The planes of one GrowState, for one round.
struct SeparatingPlanes {
    std::vector<SeparatingPlane> plane;
    std::vector<PlaneRange> range;    ///< of each plane
    std::vector<std::size_t> first;   ///< vertex -> its first entry in `side`; one past the end
    std::vector<std::uint32_t> side;  ///< twice the plane, one more where the vertex has value < 0
    std::vector<std::uint8_t> locked; ///< by vertex: must not move, for something is too close
    double rounding_error = 0;        ///< bound on that of SeparatingPlane::value
    FaceSnapshot faces;
};

/// Calls visit(plane, sign) for each plane of vertex v, whose side is that of sign * value > 0,
/// until one returns false; whether none did.
template <class Visit> bool all_planes_of(const SeparatingPlanes& planes, int v, Visit&& visit)
{
    for (std::size_t i = planes.first[v]; i < planes.first[v + 1]; ++i) {
        const std::uint32_t side = planes.side[i];
        if (!visit(planes.plane[side / 2], side % 2 == 0 ? 1.0 : -1.0))
            return false;
    }
    return true;
}

/// What becomes of the tree of inner triangles: rebuilt, or refitted with new boxes if there is one
/// already, which is sooner and as good as long as the triangles have not gone far.
enum class TreeUpdate { rebuild, refit };

/// Puts a plane between each inner triangle and every other triangle, inner or outer, that it could
/// meet while each vertex stays within its trust radius of where it is now. Triangles with a corner
/// in common have none: the fans decide about them. `inactive` vertices will not move. A plane
/// stands across the closest points of its pair, halfway between two inner triangles that move, and
/// against the other one where that does not. Each vertex is given the planes that it could reach.
/// Same planes for any number of threads.
void separate_triangles(GrowState& s, const std::vector<std::uint8_t>& inactive,
                        SeparatingPlanes& planes, TreeUpdate update = TreeUpdate::rebuild);

/// Pushes each plane between two triangles that move halfway between where these are now, as far as
/// its range allows: what one of them has left of its half serves both. Planes made anew would also
/// be turned, which costs far more. Precondition: since they were made every vertex has stayed
/// between its own and within its trust radius. The planes separate what they separated before.
void recentre_planes(const GrowState& s, SeparatingPlanes& planes);

/// Whether x is on the right side of all planes of vertex v, for certain.
inline bool on_own_sides(const SeparatingPlanes& planes, int v, const Vec3d& x)
{
    return all_planes_of(planes, v, [&](const SeparatingPlane& plane, double sign) {
        return sign * plane.value(x) > planes.rounding_error;
    });
}

} // namespace vdb_shell::growth
