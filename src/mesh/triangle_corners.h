// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdb_shell/mesh/triangle_mesh.h"

#include <array>
#include <cstddef>
#include <cstdint>

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

/// The corner that follows v, one of the triangle's.
inline std::uint32_t corner_after(const openvdb::Vec3I& triangle, std::uint32_t v)
{
    return triangle[0] == v ? triangle[1] : triangle[1] == v ? triangle[2] : triangle[0];
}

} // namespace vdb_shell
