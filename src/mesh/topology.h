// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/raw_vector.h"

#include <openvdb/Types.h>

#include <array>
#include <cstdint>
#include <vector>

namespace vdb_shell
{

/// Triangles around each vertex in ascending order: those of vertex v stand at [offset[v],
/// offset[v+1]).
struct VertexTriangles {
    std::vector<std::uint32_t> offset;
    RawVector<std::uint32_t> triangle;

    struct Range {
        const std::uint32_t *first, *last;
        const std::uint32_t* begin() const { return first; }
        const std::uint32_t* end() const { return last; }
        std::size_t size() const { return static_cast<std::size_t>(last - first); }
    };
    Range around(std::size_t vertex) const
    {
        return {triangle.data() + offset[vertex], triangle.data() + offset[vertex + 1]};
    }
};
VertexTriangles triangles_around_vertices(std::size_t vertex_count,
                                          const std::vector<openvdb::Vec3I>& triangles);

/// The vertices around each one, in the order in which its triangles turn round it.
struct Rims {
    VertexTriangles around;
    RawVector<std::uint32_t> rim;     ///< in the places of around.triangle
    std::vector<std::uint8_t> closed; ///< by vertex: its triangles form one closed fan, else no rim

    VertexTriangles::Range of(std::size_t vertex) const
    {
        const std::size_t first = around.offset[vertex];
        return {rim.data() + first,
                rim.data() + (closed[vertex] ? around.offset[vertex + 1] : first)};
    }
};
Rims rims_around_vertices(std::size_t vertex_count, const std::vector<openvdb::Vec3I>& triangles);

/// One use of an edge by a triangle's side `side` (corner side -> corner side+1).
struct EdgeUse {
    std::array<std::uint32_t, 2> edge; ///< smaller vertex first
    std::uint32_t triangle;
    std::uint8_t side;
    bool forward; ///< the triangle runs from the smaller to the larger vertex
};

using EdgeUses = RawVector<EdgeUse>;

/// All edge uses, sorted by edge, then triangle: uses of one edge stand together.
EdgeUses sorted_edge_uses(const std::vector<openvdb::Vec3I>& triangles);

} // namespace vdb_shell
