// SPDX-License-Identifier: Apache-2.0
#pragma once

// Distances between surfaces that do not meet, in doubles.

#include "mesh/triangle_tree.h"
#include "vdb_shell/mesh/triangle_mesh.h"

#include <cstdint>

namespace vdb_shell
{

/// The nearest point of a mesh.
struct NearestPoint {
    std::uint32_t triangle = 0;
    openvdb::Vec3d point{0.0};
    double distance = 0;
};

class NearestOnMesh
{
public:
    /// Keeps a reference. Precondition: the mesh has triangles.
    explicit NearestOnMesh(const TriangleMesh& mesh);
    /// Of triangles that are equally near to float32 any may be named, the same each time.
    NearestPoint nearest(const openvdb::Vec3d& point) const;

private:
    const TriangleMesh& mesh_;
    TriangleTree tree_;
};

/// Between the two surfaces, not only their vertices, to the rounding of doubles. Triangles without
/// area count as their edges. Same result for any number of threads. Precondition: they have no
/// common point, and each has a triangle.
double least_distance(const TriangleMesh& first, const TriangleMesh& second);

} // namespace vdb_shell
