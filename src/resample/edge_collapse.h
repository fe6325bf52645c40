// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdb_shell/mesh/triangle_mesh.h"
#include "vdb_shell/resample/coarsen.h"

#include <cstddef>
#include <limits>
#include <vector>

namespace vdb_shell
{

/// No collapse makes a triangle narrower than that, as longest edge over height, unless a triangle
/// around the vertex is narrower before: a vertex in a row of needles could never go otherwise.
inline constexpr double kWorstAspect = 8.0;

/// What no collapse may overstep. Lengths are in world units.
struct CollapseLimits {
    static constexpr double kNone = std::numeric_limits<double>::infinity();

    std::size_t fewest_triangles = 0; ///< collapses end where so many are left
    /// How far a vertex that has gone may lie from the triangles that took its place.
    double distance = kNone;
    /// Bound that distance for the middles of the input's edges and triangles too: on a surface of
    /// few triangles the vertices say little about what lies between them.
    bool between_vertices = false;
    double longest_edge = kNone; ///< longer edges stay
    /// The quadric error of a collapse: squared distances from the planes of all triangles that a
    /// vertex stands for, times their areas.
    double quadric_error = kNone;
    /// Added to the quadric error: this times the area around the vertex times the squared length
    /// of the edge. Where the surface is flat the quadric error says nothing, and the shortest edge
    /// goes.
    double length_weight = 1e-3;
    /// Of the vertices, how many may go in one round. In sequence each collapse would be the
    /// cheapest at its time; rounds of a bounded share stand for that order, and can be looked at
    /// in parallel.
    double share_of_round = 0.2;
    std::vector<char> fixed; ///< by vertex: it stays; empty: none has to
};

/// Edge collapses of least quadric error (Garland, Heckbert 1997, "Surface simplification using
/// quadric error metrics") onto one of the edge's own ends, in rounds of many that do not touch
/// each other, until no collapse is left within the limits that turns no triangle by more than 40
/// degrees, makes no sliver and leaves the topology as it is. Closed and manifold like the input,
/// but it may cross itself. Same result for any number of threads. Precondition: closed, manifold,
/// consistently oriented.
Coarsened collapse_edges(const TriangleMesh& mesh, const CollapseLimits& limits);

} // namespace vdb_shell
