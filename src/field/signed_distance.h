// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "mesh/topology.h"
#include "vdb_shell/mesh/triangle_mesh.h"

namespace vdb_shell
{

/// The distance of a point to one triangle of a closed, oriented surface, and its sign when that
/// triangle is the nearest: by the normal of the face, the mean of the two faces at an edge and the
/// angle-weighted one at a vertex ([15] of the paper; Baerentzen and Aanaes prove that these tell
/// inside from outside). Doubles throughout.
class SignedDistance
{
public:
    explicit SignedDistance(const TriangleMesh& mesh);

    /// World units, negative inside.
    double at(const openvdb::Vec3d& point, std::uint32_t triangle) const;
    std::array<openvdb::Vec3d, 3> corners(std::uint32_t triangle) const;

private:
    openvdb::Vec3d unit_normal(std::uint32_t triangle) const;
    openvdb::Vec3d edge_normal(std::uint32_t triangle, int side) const;

    const TriangleMesh& mesh_;
    VertexTriangles around_;
    std::vector<openvdb::Vec3d> vertex_normals_;
};

} // namespace vdb_shell
