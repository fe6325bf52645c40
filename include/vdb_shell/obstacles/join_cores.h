// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdb_shell/mesh/triangle_mesh.h"
#include "vdb_shell/shell/shell_stack.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace vdb_shell
{

/// Vertices that follow each other.
struct VertexRange {
    std::uint32_t first = 0, count = 0;
    bool holds(std::uint32_t vertex) const { return vertex >= first && vertex - first < count; }
};

/// The boundary of the solid between a surface and what it must not meet: the surface, then
/// `kept_out` turned round. Its vertices follow those of the surface.
TriangleMesh join_cores(TriangleMesh surface, const TriangleMesh& kept_out);

/// The same of a stack: the vertices of `kept_out` are pinned in all layers, and its triangles
/// follow those of the surface.
ShellStack join_cores(ShellStack stack, const TriangleMesh& kept_out);

/// The mesh without the vertices of the range and their triangles. The order of all else stays.
/// Precondition: no triangle has vertices in the range and others.
TriangleMesh drop_cores(TriangleMesh mesh, const VertexRange& cores);

/// The same of a stack. Precondition: the vertices of the range are pinned throughout.
ShellStack drop_cores(ShellStack stack, const VertexRange& cores);

/// The values of the vertices outside the range.
template <typename T> void drop_cores(std::vector<T>& by_vertex, const VertexRange& cores)
{
    const auto first = by_vertex.begin() + std::ptrdiff_t(cores.first);
    by_vertex.erase(first, first + std::ptrdiff_t(cores.count));
}

/// Whether a point of the shell is in the place of a vertex of the range. The certificate of a
/// tapered stack would take the two for one point.
bool shares_core_point(const ShellStack& stack, const VertexRange& cores);

} // namespace vdb_shell
