// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdb_shell/shell/tessellate.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

namespace vdb_shell
{

/// Corners of the face opposite each corner, counter-clockwise seen from outside a positive tet.
inline constexpr int kTetFaces[4][3] = {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}};

inline openvdb::Vec3I tet_face(const openvdb::Vec4I& tet, std::size_t opposite)
{
    const auto& face = kTetFaces[opposite];
    return {tet[face[0]], tet[face[1]], tet[face[2]]};
}

/// By which the sides of a face are known for the same.
inline std::array<std::uint32_t, 3> ascending_corners(const openvdb::Vec3I& face)
{
    std::array<std::uint32_t, 3> corners{face[0], face[1], face[2]};
    std::sort(corners.begin(), corners.end());
    return corners;
}

inline std::array<openvdb::Vec3s, 4> corners_of(const TetMesh& mesh, std::size_t tet)
{
    const openvdb::Vec4I& t = mesh.tets[tet];
    return {mesh.points[t[0]], mesh.points[t[1]], mesh.points[t[2]], mesh.points[t[3]]};
}

} // namespace vdb_shell
