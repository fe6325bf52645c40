// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdb_shell/io/texture_coordinates.h"
#include "vdb_shell/mesh/triangle_mesh.h"

#include <openvdb/math/Vec2.h>

#include <array>
#include <cstddef>
#include <vector>

namespace vdb_shell
{

/// Texture coordinates of a surface that was made of a textured one.
struct SurfaceCoordinates {
    std::vector<std::array<openvdb::Vec2d, 3>> corner; ///< by triangle
    std::size_t same = 0; ///< triangles that are triangles of the textured surface
    double farthest = 0;  ///< of a middle of the others to that surface, world units
};

/// A triangle with its three corners where a triangle of the textured surface has them takes its
/// coordinates as they are. The others, after repair or remeshing, belong to the chart that is
/// nearest to their middle: from the triangle there, those are gone through that hang together
/// without a seam and come into reach; each corner takes the coordinates of the nearest of them,
/// extended in its plane. So a prism never has coordinates from both sides of a seam, and none are
/// averaged; triangles over a seam are drawn on beyond it. Same for any number of threads.
/// Throws InvalidOption when the textured surface has no triangles.
SurfaceCoordinates surface_coordinates(const TextureCoordinates& textured,
                                       const TriangleMesh& surface);

} // namespace vdb_shell
