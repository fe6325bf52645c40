// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdb_shell/mesh/triangle_mesh.h"
#include "vdb_shell/resample/coarsen.h"

#include <cstddef>
#include <limits>
#include <vector>

namespace vdb_shell
{

/// What no collapse may overstep. Lengths are in world units.
struct CollapseLimits {
    static constexpr double kNone = std::numeric_limits<double>::infinity();

    std::size_t fewest_triangles = 0; ///< collapses end where so many are left
    /// How far a vertex that has gone may lie from the triangles that took its place.
    double distance = kNone;
    double longest_edge = kNone; ///< longer edges stay
    /// The quadric error of a collapse: squared distances from the planes of all triangles that a
    /// vertex stands for, times their areas.
    double quadric_error = kNone;
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
