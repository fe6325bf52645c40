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

/// What to do with the bends of pillars over the edges of coarse triangles, where most of the
/// sheared prisms are: smoothed, there are fewer of them, but the inner surface takes on some of
/// the outer one's roughness.
enum class Bends { kept, smoothed };

/// Where the pillars of a surface end in the shell of a coarser one of about the same shape: each
/// vertex goes along the prism in which its nearest point on the coarse surface lies. A pillar that
/// would not see its own triangles goes along the vertex's line instead, as far.
Pillars pillars_in(const TriangleMesh& coarse, const std::vector<openvdb::Vec3d>& coarse_inner,
                   const TriangleMesh& mesh, const Directions& lines, Bends bends);

} // namespace vdb_shell::growth
