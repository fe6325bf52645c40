// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdb_shell/mesh/check_mesh.h"
#include "vdb_shell/shell/tessellate.h"

#include <cstdint>

namespace vdb_shell
{

/// Whether the tets fit together face to face and their free faces are exactly the two surfaces.
struct Conformity {
    /// Faces of three or more tets, by one of those tets.
    Defect<std::uint32_t> crowded_faces;
    /// Faces shared by two tets that lie on the same side by their corner order, by tet.
    Defect<std::uint32_t> misoriented_faces;
    /// Free faces that are neither an outer nor an inner triangle of the shell, by tet: where two
    /// prisms disagree on a diagonal.
    Defect<std::uint32_t> stray_faces;
    /// Outer or inner triangles that no tet has as a face, by triangle. (An inner triangle with a
    /// pinned corner is not expected where pins have collapsed it onto the outer one.)
    Defect<std::uint32_t> missing_triangles;

    bool conforming() const
    {
        return crowded_faces.count + misoriented_faces.count + stray_faces.count +
                   missing_triangles.count ==
               0;
    }
};

/// Combinatorial: looks at indices only, so it holds for inverted tets too.
Conformity check_conformity(const PrismShell& shell, const TetMesh& tets);

} // namespace vdb_shell
