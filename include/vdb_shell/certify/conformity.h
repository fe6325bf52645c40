// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdb_shell/mesh/check_mesh.h"
#include "vdb_shell/shell/shell_stack.h"

#include <cstdint>

namespace vdb_shell
{

/// Whether the tets fit together face to face and their free faces are exactly the two surfaces.
/// Counts are of faces (triangles for `missing_triangles`); the lists name each offender once.
struct Conformity {
    /// Faces of three or more tets, by the first of those tets.
    Defect<std::uint32_t> crowded_faces;
    /// Faces whose two sides are the same by corner order, by the first tet: two tets on one side
    /// of their common face, or a tet on the wrong side of a surface triangle.
    Defect<std::uint32_t> misoriented_faces;
    /// Free faces that are neither an outer nor an inner triangle of the shell, by tet: where two
    /// prisms disagree on a diagonal, or the surface is open.
    Defect<std::uint32_t> stray_faces;
    /// Outer and inner triangles that no tet has as a free face, by triangle: each triangle with
    /// one un-pinned corner or more has to appear once as its outer corners and once as its inner
    /// corners (a pinned corner is both). A triangle with three pinned corners has no prism and is
    /// not expected; a tet there would leave stray faces.
    Defect<std::uint32_t> missing_triangles;

    bool conforming() const
    {
        return crowded_faces.count + misoriented_faces.count + stray_faces.count +
                   missing_triangles.count ==
               0;
    }
};

inline constexpr std::size_t kMostFaceSides = 8'000'000;

/// Combinatorial: looks at indices only (and at which vertices of the shell are pinned), so it
/// holds for inverted tets too. `most_sides` is how many sides of faces are held at once, about: it
/// bounds memory, at 40 bytes a side, and changes no result. A shell of ten million triangles has
/// 140 million. Precondition: corners of tets are indices into tets.points.
Conformity check_conformity(const PrismShell& shell, const TetMesh& tets,
                            std::size_t most_sides = kMostFaceSides);

/// The same of all layers together: only the outermost and the innermost surface are free; a
/// triangle is expected on them unless its three pillars are pinned in every layer. In a tapered
/// stack an inner triangle with two corners in one point is not expected either, nor are two
/// triangles with the same corners that face each other.
Conformity check_conformity(const ShellStack& stack, const TetMesh& tets,
                            std::size_t most_sides = kMostFaceSides);

} // namespace vdb_shell
