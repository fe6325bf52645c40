// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <openvdb/Types.h>

#include <array>
#include <cstddef>

namespace vdb_shell
{

/// Corners of the face opposite each corner, counter-clockwise seen from outside a positive tet.
inline constexpr int kTetFaces[4][3] = {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}};

inline openvdb::Vec3I tet_face(const openvdb::Vec4I& tet, std::size_t opposite)
{
    const auto& face = kTetFaces[opposite];
    return {tet[face[0]], tet[face[1]], tet[face[2]]};
}

} // namespace vdb_shell
