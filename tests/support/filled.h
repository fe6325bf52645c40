// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "support/broken_shells.h"
#include "support/tapered.h"

#include "vdb_shell/certify/core_certificate.h"
#include "vdb_shell/shell/core_tets.h"
#include "vdb_shell/shell/shell_stack.h"

#include <vector>

// Shells with a void, and tets that fill it.

namespace vdb_shell::test
{

/// Half as thick as the ball that it is a shell of.
inline ShellStack hollow_ball(int subdivisions = 1)
{
    const SplitShell made = scaled_shell(icosphere(1, subdivisions), 0.5f);
    return one_layer(made.shell, made.split);
}

/// One layer whose pillars have no length: no tets, and all of the solid is void.
inline ShellStack empty_shell(const TriangleMesh& mesh)
{
    const SplitShell made = with_split(
        {mesh.points, mesh.points, mesh.triangles, std::vector<StopReason>(mesh.points.size())});
    return one_layer(made.shell, made.split);
}

/// A tet from each triangle of the void to one point.
inline CoreTets cone_core(const ShellStack& stack, const TetMesh& tets, const openvdb::Vec3s& apex)
{
    const VoidSurface surface = void_surface(stack, tets);
    CoreTets core;
    core.points.assign(surface.points.begin() + std::ptrdiff_t(tets.points.size()),
                       surface.points.end());
    core.source_vertex = surface.lone_vertices;
    const auto index = static_cast<std::uint32_t>(surface.points.size());
    core.points.push_back(apex);
    core.source_vertex.push_back(CoreTets::kNoVertex);
    for (const openvdb::Vec3I& t : surface.triangles)
        core.tets.emplace_back(t[0], t[2], t[1], index);
    return core;
}

} // namespace vdb_shell::test
