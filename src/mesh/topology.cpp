// SPDX-License-Identifier: Apache-2.0
#include "mesh/topology.h"

#include "core/deal_out.h"

#include <algorithm>
#include <array>
#include <tuple>
#include <utility>

namespace vdb_shell
{

VertexTriangles triangles_around_vertices(std::size_t vertex_count,
                                          const std::vector<openvdb::Vec3I>& triangles)
{
    VertexTriangles result;
    result.offset.assign(vertex_count + 1, 0);
    for (const openvdb::Vec3I& t : triangles)
        for (int corner = 0; corner < 3; ++corner)
            ++result.offset[t[corner] + 1];
    for (std::size_t v = 0; v < vertex_count; ++v)
        result.offset[v + 1] += result.offset[v];
    result.triangle.resize(triangles.size() * 3);
    std::vector<std::uint32_t> next(result.offset.begin(), result.offset.end() - 1);
    for (std::size_t t = 0; t < triangles.size(); ++t)
        for (int corner = 0; corner < 3; ++corner)
            result.triangle[next[triangles[t][corner]]++] = static_cast<std::uint32_t>(t);
    return result;
}

std::vector<EdgeUse> sorted_edge_uses(const std::vector<openvdb::Vec3I>& triangles)
{
    std::vector<EdgeUse> uses;
    uses.reserve(triangles.size() * 3);
    for (std::size_t t = 0; t < triangles.size(); ++t) {
        for (std::uint8_t side = 0; side < 3; ++side) {
            const std::uint32_t a = triangles[t][side], b = triangles[t][(side + 1) % 3];
            uses.push_back(
                {{std::min(a, b), std::max(a, b)}, static_cast<std::uint32_t>(t), side, a < b});
        }
    }
    std::uint32_t vertices = 0;
    for (const EdgeUse& use : uses)
        vertices = std::max(vertices, use.edge[1] + 1);
    return deal_out<EdgeUse>(
        std::array{std::move(uses)}, vertices, [](const EdgeUse& use) { return use.edge[0]; },
        [](const EdgeUse& x, const EdgeUse& y) {
            return std::tie(x.edge[1], x.triangle, x.side) <
                   std::tie(y.edge[1], y.triangle, y.side);
        });
}

} // namespace vdb_shell
