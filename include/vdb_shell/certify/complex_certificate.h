// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdb_shell/certify/conformity.h"
#include "vdb_shell/core/interrupter.h"
#include "vdb_shell/mesh/check_mesh.h"
#include "vdb_shell/shell/shell_stack.h"

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace vdb_shell
{

/// The proof that the tets of a tapered stack are a geometric simplicial complex inside its
/// outermost surface, or what stands against it: the conditions of docs/theory.md, "Tapered
/// shells", all decided exactly on the stored float32 coordinates. It asks nothing of the inner
/// surfaces, which may share points, touch themselves, cancel or vanish.
///
/// A *free face* is a face of one tet only. Contacts are looked for among free faces and outer
/// triangles; an outer triangle is named by its index, another free face by that of its tet, as
/// make_tets numbers them.
struct ComplexCertificate {
    using TetAndTriangle = std::array<std::uint32_t, 2>;
    using TwoTets = std::array<std::uint32_t, 2>;

    /// As in Certificate, but by layer * triangles + triangle. Nothing else but the outer surface
    /// has been looked at if there is one.
    Defect<std::uint32_t> cyclic_prisms;
    Defect<std::uint32_t> bad_tets; ///< tets that are not positive
    Conformity conformity;
    Defect<TrianglePair> outer_contacts; ///< as in Certificate
    /// Free faces that are no outer triangles and touch; one of no area stands with itself.
    Defect<TwoTets> inner_contacts;
    Defect<TetAndTriangle> inner_through_outer; ///< the same, and an outer triangle
    /// Outer triangles that are faces of no tet, and a tet that meets them in more than common
    /// corners and edges.
    Defect<TetAndTriangle> tets_through_outer;
    /// The tet behind one face of a connected piece of free faces, and one that it overlaps.
    Defect<TwoTets> overlapping_tets;
    /// Pieces of tets that hang together by faces, have no outer triangle among their faces, and
    /// no corner that shows them to be behind the outer surface, by first tet.
    Defect<std::uint32_t> detached_tets;
    Defect<Edge> open_edges;                ///< of the outer surface, as in Certificate
    Defect<std::uint32_t> split_vertices;   ///< of the outer surface, as in Certificate
    Defect<std::uint32_t> doubled_vertices; ///< outer vertices in the place of one before

    /// No failure at all.
    bool certified() const;
    /// As Certificate::locally_valid.
    bool locally_valid() const;
    /// As Certificate::failures.
    std::vector<std::string> failures() const;
};

/// Never throws for a bad shell. O(n log n) for surfaces whose boxes of triangles rarely overlap.
/// Same findings for any number of threads. Precondition: as certify_stack. Throws Cancelled.
ComplexCertificate certify_complex(const ShellStack& stack, Interrupter* interrupter = nullptr);

} // namespace vdb_shell
