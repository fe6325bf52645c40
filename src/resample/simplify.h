// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdb_shell/core/interrupter.h"
#include "vdb_shell/mesh/triangle_mesh.h"

#include <cstddef>

namespace vdb_shell
{

struct SimplifyLimits {
    double tolerance;    ///< how far the surface may move, world units; may be infinite
    double longest_edge; ///< no longer edge is collapsed; infinite: any is
    std::size_t fewest_triangles = 0; ///< collapses end here
    bool bound_quadric = true;        ///< hold the quadric error under the tolerance too
    bool between_vertices = false;    ///< look at the middles of edges and triangles too
};

struct Simplified {
    TriangleMesh mesh; ///< its points are some of the input's, unchanged
    int repeats = 0;   ///< how often some vertices had to be held
};

/// Edge collapses in the order of their quadric error (edge_collapse.h) that move the surface by no
/// more than the tolerance (the distance from what was collapsed to what is left), nor turn a
/// triangle far. What comes out is closed, manifold and embedded like what went in, and no
/// component of it has turned inside out. No edge longer than the limit is collapsed: what is flat
/// keeps triangles of about that size, and the distances do not cost more and more. Where triangles
/// touch, the vertices around them are held and all is done anew; the input itself is the last
/// resort. Precondition: closed, manifold, embedded.
Simplified simplify(const TriangleMesh& mesh, const SimplifyLimits& limits,
                    Interrupter* interrupter);

} // namespace vdb_shell
