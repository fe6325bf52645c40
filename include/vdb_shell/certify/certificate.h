// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdb_shell/core/interrupter.h"
#include "vdb_shell/mesh/check_mesh.h"
#include "vdb_shell/shell/tessellate.h"

#include <cstdint>
#include <string>
#include <vector>

namespace vdb_shell {

/// Which tets of each prism have to be positive.
enum class PrismTest {
    twelve_tets, ///< those of all six splits: any diagonals and any thinner shell are valid too
    chosen_tets, ///< the three of the given split
};

/// The proof that a shell is free of inverted and of overlapping tets, or what stands against it.
/// Conditions of docs/theory.md, all decided exactly on the stored float32 coordinates.
struct Certificate {
    PrismTest test = PrismTest::twelve_tets;
    Defect<std::uint32_t> bad_prisms;          ///< prisms with a tet that is not positive, by triangle
    Defect<Edge> non_conforming_edges;         ///< the two prisms beside an edge disagree on its diagonal
    Defect<std::uint32_t> cyclic_prisms;       ///< an order that is no permutation of the three corners
    Defect<TrianglePair> outer_contacts;       ///< outer surface against itself
    Defect<TrianglePair> inner_folds;          ///< inner triangles that share corners and touch elsewhere
    Defect<TrianglePair> inner_contacts;       ///< inner triangles that share no corner and touch
    Defect<TrianglePair> inner_through_outer;  ///< inner (first) and outer (second) triangles that touch
    Defect<std::uint32_t> inside_out_components; ///< inner surface of this component has the wrong orientation, by first triangle
    Defect<TrianglePair> nested_wrongly;       ///< pairs of components, by first triangle, whose shells enclose each other's
    Defect<Edge> open_edges;                   ///< the surface is not closed, manifold and consistently oriented

    /// No failure at all: the tets are a geometric simplicial complex.
    bool certified() const;
    /// Every tet is positive and conforms, but the surface or the shell crosses itself or that is not known: an immersed shell.
    bool locally_valid() const;
    /// One line for each kind of failure, by name, count and first indices; empty when certified.
    std::vector<std::string> failures() const;
};

/// Certifies any shell, one read from a file included. Pinned vertices are treated as shared by both surfaces.
/// Cost O(F log F). Never throws for a bad shell; throws Cancelled.
Certificate certify_shell(const PrismShell& shell, const PrismSplit& split, PrismTest test,
                          Interrupter* interrupter = nullptr);

} // namespace vdb_shell
