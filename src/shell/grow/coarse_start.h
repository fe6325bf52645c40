// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdb_shell/mesh/triangle_mesh.h"
#include "vdb_shell/step/directions.h"

#include <openvdb/Types.h>

#include <vector>

namespace vdb_shell::growth
{

/// The pillars up to given inner points as lines.
struct Pillars {
    Directions lines; ///< visibility is that of the lines they were before
    std::vector<double> length;
};

/// Vertices that have no pillar keep their line, for growth may release them.
Pillars pillars_to(const TriangleMesh& mesh, const std::vector<openvdb::Vec3s>& inner,
                   Directions lines);

/// Where the pillars of a surface end in the shell of a coarser one of about the same shape: each
/// vertex goes along the prism in which its nearest point on the coarse surface lies. A pillar that
/// would not see its own triangles goes along the vertex's line instead, as far.
Pillars pillars_in(const TriangleMesh& coarse, const std::vector<openvdb::Vec3d>& coarse_inner,
                   const TriangleMesh& mesh, const Directions& lines);

} // namespace vdb_shell::growth
