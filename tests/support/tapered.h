// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "support/broken_shells.h"

#include "vdb_shell/shell/shell_stack.h"

#include <vector>

// Stacks whose vertices share inner points.

namespace vdb_shell::test
{

/// Layers between surfaces of the same triangles, the outermost first.
inline ShellStack tapered_stack(const std::vector<std::vector<openvdb::Vec3s>>& surfaces,
                                const std::vector<openvdb::Vec3I>& triangles)
{
    ShellStack stack;
    stack.tapered = true;
    for (std::size_t k = 0; k + 1 < surfaces.size(); ++k) {
        PrismShell layer{surfaces[k], surfaces[k + 1], triangles, {}};
        layer.stop.assign(surfaces[k].size(), StopReason::prism);
        SplitShell made = with_split(std::move(layer));
        stack.layers.push_back(std::move(made.shell));
        stack.splits.push_back(std::move(made.split));
    }
    return stack;
}

inline ShellStack tapered(const SplitShell& made)
{
    ShellStack stack = one_layer(made.shell, made.split);
    stack.tapered = true;
    return stack;
}

inline std::vector<openvdb::Vec3s> all_at(const openvdb::Vec3s& point, std::size_t count)
{
    return std::vector<openvdb::Vec3s>(count, point);
}

/// All pillars end in one point.
inline ShellStack coned(const TriangleMesh& mesh, const openvdb::Vec3s& point)
{
    return tapered_stack({mesh.points, all_at(point, mesh.points.size())}, mesh.triangles);
}

/// Corners +x, -x, +y, -y, +z, -z.
inline TriangleMesh octahedron()
{
    return {
        {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}},
        {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}, {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}}};
}

/// The inner points of +x and -x are the centre, so that the inner surface is two sheets in the
/// plane x = 0, one on the other.
inline ShellStack two_sheets()
{
    const TriangleMesh mesh = octahedron();
    std::vector<openvdb::Vec3s> inner = mesh.points;
    for (openvdb::Vec3s& p : inner)
        p *= 0.5f;
    inner[0] = inner[1] = openvdb::Vec3s(0);
    return tapered_stack({mesh.points, inner}, mesh.triangles);
}

/// A hexagonal rod of height 4 about z. The ring in the middle ends in one point, in which two
/// cavities meet.
inline ShellStack pinched_rod()
{
    std::vector<openvdb::Vec2d> ring;
    for (int i = 0; i < 6; ++i)
        ring.emplace_back(std::cos(i * M_PI / 3), std::sin(i * M_PI / 3));
    const TriangleMesh rod = extruded(ring, {-2, -1, 0, 1, 2});
    std::vector<openvdb::Vec3s> inner;
    for (const openvdb::Vec3s& p : rod.points)
        inner.push_back(p[2] == 0 ? openvdb::Vec3s(0)
                                  : openvdb::Vec3s(0.5f * p[0], 0.5f * p[1], 0.75f * p[2]));
    return tapered_stack({rod.points, inner}, rod.triangles);
}

/// Three layers. The surfaces shrink, three vertices share a point on the last but one, and all on
/// the last.
inline ShellStack layers_to_a_point()
{
    const TriangleMesh ball = icosphere(1, 1);
    std::vector<std::vector<openvdb::Vec3s>> surfaces(3, ball.points);
    const openvdb::Vec3I& t = ball.triangles[5];
    for (std::size_t k = 1; k < 3; ++k)
        for (openvdb::Vec3s& p : surfaces[k])
            p *= k == 1 ? 0.75f : 0.5f;
    const openvdb::Vec3s shared =
        (surfaces[2][t[0]] + surfaces[2][t[1]] + surfaces[2][t[2]]) / 3.0f;
    for (int k = 0; k < 3; ++k)
        surfaces[2][t[k]] = shared;
    surfaces.push_back(all_at(openvdb::Vec3s(0), ball.points.size()));
    return tapered_stack(surfaces, ball.triangles);
}

} // namespace vdb_shell::test
