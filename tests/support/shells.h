// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdb_shell/shell/prism_shell.h"

#include <cmath>
#include <functional>

// Shells whose directions and lengths are given by formula.

namespace vdb_shell::test
{

using VertexLength = std::function<double(std::size_t)>;
using VertexDirection = std::function<openvdb::Vec3d(const openvdb::Vec3d&)>;

inline PrismShell shell_along(const TriangleMesh& mesh, const VertexDirection& direction,
                              const VertexLength& length)
{
    Directions directions;
    LineLengths lengths;
    for (std::size_t v = 0; v < mesh.points.size(); ++v) {
        directions.inward.push_back(direction(openvdb::Vec3d(mesh.points[v])));
        directions.visibility.push_back(1);
        lengths.length.push_back(length(v));
        lengths.steps.push_back(1);
        lengths.reason.push_back(StopReason::thickness);
    }
    return extrude(mesh, directions, lengths);
}

/// Towards the origin.
inline PrismShell radial_shell(const TriangleMesh& mesh, const VertexLength& length)
{
    return shell_along(
        mesh, [](const openvdb::Vec3d& p) { return -p.unit(); }, length);
}

/// A torus around z, towards its centre circle of radius `major`.
inline PrismShell torus_shell(const TriangleMesh& mesh, double major, const VertexLength& length)
{
    return shell_along(
        mesh,
        [=](const openvdb::Vec3d& p) {
            const openvdb::Vec3d centre = openvdb::Vec3d(p[0], p[1], 0).unit() * major;
            return (centre - p).unit();
        },
        length);
}

} // namespace vdb_shell::test
