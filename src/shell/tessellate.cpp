// SPDX-License-Identifier: Apache-2.0
#include "vdb_shell/shell/tessellate.h"

#include "core/parallel.h"
#include "shell/ripple.h"

#include <algorithm>
#include <cassert>
#include <utility>

namespace vdb_shell
{
namespace
{

using openvdb::Vec3I;
using openvdb::Vec4I;

constexpr std::uint32_t kNoPoint = ~std::uint32_t(0);

/// Smallest key first, ties by vertex index. A strict order of all vertices has no cycle inside any
/// triangle, so it always gives a consistent split.
PrismSplit split_by_key(const PrismShell& shell, const std::vector<double>& key)
{
    PrismSplit split;
    split.order.resize(shell.triangles.size());
    for_each_index(shell.triangles.size(), [&](std::size_t t) {
        const Vec3I& triangle = shell.triangles[t];
        std::array<std::uint8_t, 3>& order = split.order[t];
        order = {0, 1, 2};
        std::sort(order.begin(), order.end(), [&](std::uint8_t x, std::uint8_t y) {
            const std::uint32_t u = triangle[x], v = triangle[y];
            return std::make_pair(key[u], u) < std::make_pair(key[v], v);
        });
    });
    return split;
}

std::vector<double> scaled_lengths(const PrismShell& shell, double factor)
{
    std::vector<double> lengths(shell.outer.size());
    for_each_index(lengths.size(), [&](std::size_t v) { lengths[v] = factor * shell.length(v); });
    return lengths;
}

std::vector<std::uint8_t> pinned_vertices(const PrismShell& shell)
{
    std::vector<std::uint8_t> pinned(shell.outer.size());
    for_each_index(pinned.size(), [&](std::size_t v) { pinned[v] = shell.pinned(v) ? 1 : 0; });
    return pinned;
}

bool has_tets(const Vec3I& triangle, const std::vector<std::uint8_t>& pinned)
{
    return !(pinned[triangle[0]] && pinned[triangle[1]] && pinned[triangle[2]]);
}

/// Index of each vertex's outer and inner point in the tet mesh.
struct PointIndex {
    std::vector<std::uint32_t> outer, inner;
};

/// Every point of a prism with tets is a corner of one of them: an un-pinned pillar's ends are both
/// in the pillar's own tet, which also holds one end of each other pillar.
PointIndex number_points(const PrismShell& shell, const std::vector<std::uint8_t>& pinned,
                         TetMesh& mesh)
{
    std::vector<std::uint8_t> used(shell.outer.size(), 0);
    for (const Vec3I& triangle : shell.triangles)
        if (has_tets(triangle, pinned))
            for (int corner = 0; corner < 3; ++corner)
                used[triangle[corner]] = 1;
    auto append = [&](const openvdb::Vec3s& point, std::size_t vertex, std::uint8_t layer) {
        mesh.points.push_back(point);
        mesh.source_vertex.push_back(static_cast<std::uint32_t>(vertex));
        mesh.layer.push_back(layer);
        return static_cast<std::uint32_t>(mesh.points.size() - 1);
    };
    PointIndex index;
    index.outer.assign(shell.outer.size(), kNoPoint);
    for (std::size_t v = 0; v < used.size(); ++v)
        if (used[v])
            index.outer[v] = append(shell.outer[v], v, 0);
    index.inner = index.outer;
    for (std::size_t v = 0; v < used.size(); ++v)
        if (used[v] && !pinned[v])
            index.inner[v] = append(shell.inner[v], v, 1);
    return index;
}

/// The tet that owns the pillar of each corner, from last to first in the prism's order, so from
/// the outer to the inner triangle. Positive where the prism is not inverted: below a triangle
/// that is counter-clockwise from outside, (ax,ay,by,bz) is positive and the other two negative
/// when x,y,z is an even permutation of the corners, and the reverse when it is odd.
std::array<Vec4I, 3> tets_of(const Vec3I& triangle, const std::array<std::uint8_t, 3>& order,
                             const PointIndex& index)
{
    const std::uint32_t x = triangle[order[0]], y = triangle[order[1]], z = triangle[order[2]];
    const std::vector<std::uint32_t>&a = index.outer, &b = index.inner;
    std::array<Vec4I, 3> tets{Vec4I(a[x], a[y], a[z], b[z]), Vec4I(a[x], a[y], b[y], b[z]),
                              Vec4I(a[x], b[x], b[y], b[z])};
    const bool even = (order[0] + 1) % 3 == order[1];
    if (even) {
        std::swap(tets[0][1], tets[0][2]);
        std::swap(tets[2][2], tets[2][3]);
    } else {
        std::swap(tets[1][2], tets[1][3]);
    }
    return tets;
}

} // namespace

PrismSplit split_prisms(const PrismShell& shell, const SplitOptions& options)
{
    switch (options.rule) {
    case SplitRule::vertex_index:
        return split_by_key(shell, std::vector<double>(shell.outer.size(), 0.0));
    case SplitRule::length_descending:
        return split_by_key(shell, scaled_lengths(shell, -1));
    case SplitRule::length_ascending:
        return split_by_key(shell, scaled_lengths(shell, 1));
    case SplitRule::ripple:
        return ripple_split(shell.triangles, options.seed);
    }
    assert(false);
    return {};
}

TetMesh make_tets(const PrismShell& shell, const PrismSplit& split)
{
    assert(split.order.size() == shell.triangles.size());
    const std::vector<std::uint8_t> pinned = pinned_vertices(shell);
    TetMesh mesh;
    const PointIndex index = number_points(shell, pinned, mesh);
    mesh.tets.reserve(3 * shell.triangles.size());
    mesh.prism.reserve(3 * shell.triangles.size());
    for (std::size_t t = 0; t < shell.triangles.size(); ++t) {
        const Vec3I& triangle = shell.triangles[t];
        const std::array<Vec4I, 3> tets = tets_of(triangle, split.order[t], index);
        for (std::size_t i = 0; i < 3; ++i) {
            if (pinned[triangle[split.order[t][2 - i]]])
                continue;
            mesh.tets.push_back(tets[i]);
            mesh.prism.push_back(static_cast<std::uint32_t>(t));
        }
    }
    return mesh;
}

} // namespace vdb_shell
