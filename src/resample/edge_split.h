// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdb_shell/mesh/triangle_mesh.h"

#include <array>
#include <cstdint>
#include <vector>

namespace vdb_shell
{

/// The edges of a surface, each once, ascending by their points.
struct EdgeList {
    std::vector<std::array<std::uint32_t, 2>> ends;      ///< smaller point first
    std::vector<std::array<std::uint32_t, 3>> triangles; ///< per triangle: edge of side k, corner k
                                                         ///< to corner k+1
};
EdgeList edges_of(const std::vector<openvdb::Vec3I>& triangles);

struct EdgeSplit {
    TriangleMesh mesh; ///< the points of before, then the middles in the order of the edges
    std::vector<std::uint32_t> source; ///< per triangle: the one that it is a piece of
    std::vector<std::uint32_t> edge;   ///< per new point: the edge that it halves
};

/// Halves the marked edges, in the middle rounded to float32, and cuts the triangles around them:
/// three marks give four pieces of the same shape, two or one give three or two. A triangle of one
/// or two marks is first cut at the side that `first_cut` names, which has to be marked.
/// Conforming, for both triangles of an edge see the same mark. Pieces stand together, in the order
/// of the triangles, and turn as these do.
EdgeSplit split_edges(const TriangleMesh& mesh, const EdgeList& edges,
                      const std::vector<char>& marked, const std::vector<std::uint8_t>& first_cut);

} // namespace vdb_shell
