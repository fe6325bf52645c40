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

/// inner = outer + length * inward in double, rounded to the nearest float32 point, then stepped
/// back by single floats while the pillar is longer than asked: neither its exact length nor
/// PrismShell::length() exceeds `lengths.length`. Pinned are the vertices of length 0, those
/// without a direction, and those whose length is lost in the rounding.
/// Precondition: one entry per vertex in all lists; lengths finite and not negative.
PrismShell extrude(const TriangleMesh& mesh, const Directions& directions,
                   const LineLengths& lengths);

/// The inner surface as a mesh, vertex for vertex and oriented like the outer one. Where all three
/// corners of a triangle are pinned it coincides with the outer triangle.
TriangleMesh inner_surface(const PrismShell& shell);

} // namespace vdb_shell
