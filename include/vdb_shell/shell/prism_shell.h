// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdb_shell/mesh/triangle_mesh.h"
#include "vdb_shell/step/line_step.h"

#include <vector>

namespace vdb_shell
{

/// A shell of one triangle prism under each surface triangle: inner[i] hangs below outer[i].
/// A vertex with inner[i] == outer[i] is *pinned*: its pillar has no length.
struct PrismShell {
    std::vector<openvdb::Vec3s> outer;
    std::vector<openvdb::Vec3s> inner;
    std::vector<openvdb::Vec3I> triangles;
    std::vector<StopReason> stop; ///< why each pillar ends where it does

    bool pinned(std::size_t vertex) const { return inner[vertex] == outer[vertex]; }
    double length(std::size_t vertex) const
    {
        return (openvdb::Vec3d(inner[vertex]) - openvdb::Vec3d(outer[vertex])).length();
    }
};

/// inner = outer + length * inward, rounded to float32 so that no pillar is longer than asked.
PrismShell extrude(const TriangleMesh& mesh, const Directions& directions,
                   const LineLengths& lengths);

/// The inner surface as a mesh, oriented like the outer one.
TriangleMesh inner_surface(const PrismShell& shell);

} // namespace vdb_shell
