// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdb_shell/mesh/triangle_mesh.h"

#include <array>
#include <cstddef>

namespace vdb_shell
{

/// The corners of a triangle in doubles, in which products of float32 coordinates are nearly exact.
inline std::array<openvdb::Vec3d, 3> triangle_corners(const TriangleMesh& mesh,
                                                      std::size_t triangle)
{
    const openvdb::Vec3I& t = mesh.triangles[triangle];
    return {openvdb::Vec3d(mesh.points[t[0]]), openvdb::Vec3d(mesh.points[t[1]]),
            openvdb::Vec3d(mesh.points[t[2]])};
}

} // namespace vdb_shell
