// SPDX-License-Identifier: Apache-2.0

// Which triangles are around a vertex, in which order they turn round it, and which of them share
// an edge. Lists of all vertices stand in one array, with the start of each (compressed rows),
// filled by counting: linear time and no list to allocate for each vertex. All orders follow from
// the indices alone. Traps: starts are 32 bits wide, so the corners of all triangles have to be
// fewer than 2^32; a triangle that names a vertex twice stands in its list twice.

#include "mesh/topology.h"

#include "core/key_ranges.h"
#include "core/parallel.h"
#include "core/stage_stop.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <numeric>
#include <tuple>
#include <utility>

namespace vdb_shell
{

VertexTriangles triangles_around_vertices(std::size_t vertex_count,
                                          const std::vector<openvdb::Vec3I>& triangles)
{
    VertexTriangles result;
    std::vector<std::uint32_t>& offset = result.offset;
    offset.assign(vertex_count + 1, 0);
    const std::size_t corners = triangles.size() * 3;
    for_each_key_range(vertex_count, corners, [&](std::size_t first, std::size_t last) {
        for (const openvdb::Vec3I& t : triangles)
            for (int corner = 0; corner < 3; ++corner)
                // Vertices before the first wrap around.
                if (t[corner] - first < last - first)
                    ++offset[t[corner] + 1];
    });
    // Where each list begins, which filling it moves to its end: where the next one begins.
    std::uint32_t begin = 0;
    for (std::size_t v = 1; v <= vertex_count; ++v)
        begin += std::exchange(offset[v], begin);
    result.triangle.resize(corners);
    for_each_key_range(vertex_count, corners, [&](std::size_t first, std::size_t last) {
        // Triangles come in ascending order, so each vertex gets its list in ascending order.
        for (std::size_t t = 0; t < triangles.size(); ++t)
            for (int corner = 0; corner < 3; ++corner)
                if (const std::uint32_t v = triangles[t][corner]; v - first < last - first)
                    result.triangle[offset[v + 1]++] = static_cast<std::uint32_t>(t);
    });
    return result;
}

namespace
{

// From this many triangles on a sorted list is quicker than a search through all at each step.
constexpr std::size_t kLargeStar = 64;

/// Finds the triangle of a star whose side begins at a point: of several the first.
template <typename SideOf> class NextSide
{
public:
    NextSide(const VertexTriangles::Range& around, const SideOf& side_of)
        : around_(around), side_of_(side_of)
    {
        if (around.size() < kLargeStar)
            return;
        for (const std::uint32_t t : around)
            sorted_.emplace_back(side_of(t)[0], t);
        std::sort(sorted_.begin(), sorted_.end());
    }

    /// False where there is none.
    bool find(std::uint32_t point, std::uint32_t& triangle) const
    {
        if (!sorted_.empty()) {
            const auto at =
                std::lower_bound(sorted_.begin(), sorted_.end(), std::make_pair(point, 0U));
            triangle = at == sorted_.end() ? 0 : at->second;
            return at != sorted_.end() && at->first == point;
        }
        const auto at = std::find_if(around_.begin(), around_.end(),
                                     [&](std::uint32_t t) { return side_of_(t)[0] == point; });
        triangle = at == around_.end() ? 0 : *at;
        return at != around_.end();
    }

private:
    const VertexTriangles::Range& around_;
    const SideOf& side_of_;
    std::vector<std::pair<std::uint32_t, std::uint32_t>> sorted_;
};

/// Writes the rim of vertex v to `rim`; false where its triangles do not turn round it once.
bool list_rim(const std::vector<openvdb::Vec3I>& triangles, const VertexTriangles::Range& around,
              std::uint32_t v, std::uint32_t* rim)
{
    // The corner after v, and the one after that.
    const auto side_of = [&](std::uint32_t t) -> std::array<std::uint32_t, 2> {
        const openvdb::Vec3I& c = triangles[t];
        const int k = c[0] == v ? 0 : c[1] == v ? 1 : 2;
        return {c[(k + 1) % 3], c[(k + 2) % 3]};
    };
    if (around.size() == 0)
        return false;
    const NextSide next(around, side_of);
    std::array<std::uint32_t, 2> side = side_of(*around.begin());
    const std::uint32_t start = side[0];
    for (std::size_t i = 0; i < around.size(); ++i) {
        rim[i] = side[0];
        // Back at the start too early, there is more than one fan; not back at the end, the fan is
        // open or the triangles disagree in orientation.
        const bool last = i + 1 == around.size();
        if (last || side[1] == start)
            return last && side[1] == start;
        std::uint32_t triangle = 0;
        if (!next.find(side[1], triangle))
            return false;
        side = side_of(triangle);
    }
    return false;
}

} // namespace

Rims rims_around_vertices(std::size_t vertex_count, const std::vector<openvdb::Vec3I>& triangles)
{
    Rims rims{triangles_around_vertices(vertex_count, triangles), {}, {}};
    rims.rim.resize(rims.around.triangle.size());
    rims.closed.resize(vertex_count);
    for_each_index(vertex_count, [&](std::size_t v) {
        rims.closed[v] = list_rim(triangles, rims.around.around(v), static_cast<std::uint32_t>(v),
                                  rims.rim.data() + rims.around.offset[v]);
    });
    return rims;
}

namespace
{

/// Calls visit(use) for the uses of which this vertex is the smaller one, by triangle and side.
template <class Visit>
void for_each_use_from(std::uint32_t vertex, const std::vector<openvdb::Vec3I>& triangles,
                       const VertexTriangles::Range& around, const Visit& visit)
{
    for (const std::uint32_t* t = around.begin(); t != around.end(); ++t) {
        // A triangle that has a corner twice stands there twice.
        if (t != around.begin() && *t == t[-1])
            continue;
        for (std::uint8_t side = 0; side < 3; ++side) {
            const std::uint32_t a = triangles[*t][side], b = triangles[*t][(side + 1) % 3];
            if (std::min(a, b) == vertex)
                visit(EdgeUse{{vertex, std::max(a, b)}, *t, side, a < b});
        }
    }
}

} // namespace

EdgeUses sorted_edge_uses(const std::vector<openvdb::Vec3I>& triangles)
{
    std::uint32_t vertices = 0;
    for (const openvdb::Vec3I& t : triangles)
        vertices = std::max(vertices, std::max({t[0], t[1], t[2]}) + 1);
    const VertexTriangles around = triangles_around_vertices(vertices, triangles);
    stop_if_stage_wants();
    // By vertex, where the uses begin of which it is the smaller one.
    std::vector<std::size_t> begin(vertices + std::size_t(1), 0);
    for_each_index(vertices, [&](std::size_t v) {
        for_each_use_from(std::uint32_t(v), triangles, around.around(v),
                          [&](const EdgeUse&) { ++begin[v + 1]; });
    });
    std::partial_sum(begin.begin(), begin.end(), begin.begin());
    EdgeUses uses(begin.back());
    for_each_index(vertices, [&](std::size_t v) {
        std::size_t end = begin[v];
        for_each_use_from(std::uint32_t(v), triangles, around.around(v),
                          [&](const EdgeUse& use) { uses[end++] = use; });
        // Triangle and side tell all uses of an edge apart, so the order is unique.
        std::sort(uses.begin() + std::ptrdiff_t(begin[v]), uses.begin() + std::ptrdiff_t(end),
                  [](const EdgeUse& x, const EdgeUse& y) {
                      return std::tie(x.edge[1], x.triangle, x.side) <
                             std::tie(y.edge[1], y.triangle, y.side);
                  });
    });
    return uses;
}

} // namespace vdb_shell
