// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdb_shell/core/interrupter.h"
#include "vdb_shell/mesh/check_mesh.h"
#include "vdb_shell/shell/prism_test.h"
#include "vdb_shell/shell/tessellate.h"

#include <cstdint>
#include <string>
#include <vector>

namespace vdb_shell
{

/// The proof that a shell is free of inverted and of overlapping tets, or what stands against it.
/// Conditions of docs/theory.md, "The whole shell", all decided exactly on the stored float32
/// coordinates.
struct Certificate {
    PrismTest test = PrismTest::twelve_tets;
    Defect<std::uint32_t> bad_prisms; ///< prisms with a tet that is not positive, by triangle
    /// The two prisms beside an edge without a pinned end disagree on its diagonal.
    Defect<Edge> non_conforming_edges;
    /// An order that is no permutation of the three corners. Of such a prism no diagonal is known:
    /// it is not among the other findings about splits.
    Defect<std::uint32_t> cyclic_prisms;
    /// Outer surface against itself; a triangle of no area stands with itself.
    Defect<TrianglePair> outer_contacts;
    /// Inner triangles that share corners and touch elsewhere; a triangle of no area stands with
    /// itself.
    Defect<TrianglePair> inner_folds;
    Defect<TrianglePair> inner_contacts; ///< inner triangles that share no corner and touch
    /// Inner (first) and outer (second) triangles that touch, other than in pinned corners and
    /// edges between pinned corners.
    Defect<TrianglePair> inner_through_outer;
    /// Closed components whose two surfaces enclose volumes of different sign (exact sums), by
    /// first triangle.
    Defect<std::uint32_t> inside_out_components;
    /// Pairs of closed components, by first triangle, that do not touch, but one of which has a
    /// surface in the region between the surfaces of the other.
    Defect<TrianglePair> nested_wrongly;
    /// Edges that are not run through exactly once each way: the surface is not closed, manifold
    /// and consistently oriented.
    Defect<Edge> open_edges;
    /// Vertices whose triangles do not hang together by edges.
    Defect<std::uint32_t> split_vertices;

    /// No failure at all: the tets are a geometric simplicial complex.
    bool certified() const;
    /// Every tet asked for is positive and conforms, on a closed surface: no tet is inverted, and
    /// tets that share a face lie on either side of it. All that can be said of a surface that
    /// crosses itself; nothing is said of tets that share no face. Implied by certified().
    bool locally_valid() const;
    /// One line for each kind of failure: its name as above, its count and the first indices;
    /// empty when certified.
    std::vector<std::string> failures() const;
};

/// Certifies any shell, however it was made, one read from a file included. Pinned vertices are
/// shared by both surfaces; a prism with three of them has no tets and no inner triangle. The shell
/// may lie on either side of its surface (cavities, outward shells): what counts is that its tets
/// are positive. Same findings for any number of threads. O(F log F) for surfaces whose boxes of
/// triangles rarely overlap and few components that enclose each other.
/// Never throws for a bad shell. Precondition, as in a file that was read: finite points, one inner
/// for each outer, one order for each triangle, corners in range. Throws Cancelled.
Certificate certify_shell(const PrismShell& shell, const PrismSplit& split, PrismTest test,
                          Interrupter* interrupter = nullptr);

} // namespace vdb_shell
