// SPDX-License-Identifier: Apache-2.0

// Takes: prisms. Gives: the order of the corners of each prism, which fixes its diagonals, and the
// tets of that order. Any total order of all vertices makes neighbouring prisms agree, so there is
// nothing to repair afterwards (docs/theory.md, "Splits"; Dompierre, Labbe, Vallet, Camarero, "How
// to Subdivide Pyramids, Prisms and Hexahedra into Tetrahedra", 1999). No coordinate is computed or
// compared here but for the pins: points are copied bit by bit. The trap is the pinned pillar: its
// two ends are one point with one index, and the tet that would stand on it must not be made.

#include "vdb_shell/shell/tessellate.h"

#include "vdb_shell/options/option.h"
#include "vdb_shell/shell/shell_stack.h"

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

/// Smallest key first, ties by vertex index. The tie makes it a strict order of all vertices, which
/// has no cycle inside any triangle, and both triangles at an edge compare the same two pairs: so
/// the split is always consistent. Keys are lengths of pillars, which are finite, so no comparison
/// meets a NaN.
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

/// A factor of -1 turns the order round without a second comparison. It makes -0.0 of a pinned
/// pillar's length, which compares equal to 0.0, so pinned vertices are ties all the same.
std::vector<double> scaled_lengths(const PrismShell& shell, double factor)
{
    std::vector<double> lengths(shell.outer.size());
    for_each_index(lengths.size(), [&](std::size_t v) { lengths[v] = factor * shell.length(v); });
    return lengths;
}

using Flags = std::vector<std::uint8_t>;

Flags pinned_vertices(const PrismShell& shell)
{
    Flags pinned(shell.outer.size());
    for_each_index(pinned.size(), [&](std::size_t v) { pinned[v] = shell.pinned(v) ? 1 : 0; });
    return pinned;
}

bool has_tets(const Vec3I& triangle, const Flags& pinned)
{
    return !(pinned[triangle[0]] && pinned[triangle[1]] && pinned[triangle[2]]);
}

/// Index of each vertex's point on one surface.
using PointIndex = std::vector<std::uint32_t>;

/// Marks the corners of the prisms that have tets. Each of them is a corner of a tet: both ends of
/// an un-pinned pillar are in the pillar's own tet, which also holds one end of each other pillar;
/// the other end of that pillar is either in its own tet or, if the pillar is pinned, the same
/// point.
void mark_used(const PrismShell& layer, const Flags& pinned, Flags& used)
{
    for (const Vec3I& triangle : layer.triangles)
        if (has_tets(triangle, pinned))
            for (int corner = 0; corner < 3; ++corner)
                used[triangle[corner]] = 1;
}

/// A point for each vertex in use on each surface; where the pillar between two surfaces is pinned,
/// the lower one has no point of its own and uses that of the surface above. Points that no tet
/// uses are left out: TetMesh promises that each point is a corner of some tet.
std::vector<PointIndex> number_points(const PrismShell* layers, const std::vector<Flags>& pinned,
                                      TetMesh& mesh)
{
    const std::size_t vertices = layers->outer.size(), count = pinned.size();
    std::vector<Flags> used(count + 1, Flags(vertices, 0));
    for (std::size_t k = 0; k < count; ++k) {
        mark_used(layers[k], pinned[k], used[k]);
        mark_used(layers[k], pinned[k], used[k + 1]);
    }
    // A shared point is in use when any of the surfaces that share it uses it. From the innermost
    // surface outward, because a pillar may be pinned in several layers one above the other, and
    // the mark has to reach the topmost of them.
    for (std::size_t k = count; k-- > 0;)
        for (std::size_t v = 0; v < vertices; ++v)
            if (pinned[k][v])
                used[k][v] = used[k][v] | used[k + 1][v];
    std::vector<PointIndex> index(count + 1, PointIndex(vertices, kNoPoint));
    for (std::size_t k = 0; k <= count; ++k) {
        const std::vector<openvdb::Vec3s>& points =
            k < count ? layers[k].outer : layers[count - 1].inner;
        for (std::size_t v = 0; v < vertices; ++v) {
            if (k > 0 && pinned[k - 1][v]) {
                index[k][v] = index[k - 1][v];
            } else if (used[k][v]) {
                index[k][v] = static_cast<std::uint32_t>(mesh.points.size());
                mesh.points.push_back(points[v]);
                mesh.source_vertex.push_back(static_cast<std::uint32_t>(v));
                mesh.layer.push_back(static_cast<std::uint8_t>(k));
            }
        }
    }
    return index;
}

/// The tet that owns the pillar of each corner, from last to first in the prism's order, so from
/// the outer to the inner triangle. Positive where the prism is not inverted: below a triangle
/// that is counter-clockwise from outside, (ax,ay,by,bz) is positive and the other two negative
/// when x,y,z is an even permutation of the corners, and the reverse when it is odd.
std::array<Vec4I, 3> tets_of(const Vec3I& triangle, const std::array<std::uint8_t, 3>& order,
                             const PointIndex& a, const PointIndex& b)
{
    const std::uint32_t x = triangle[order[0]], y = triangle[order[1]], z = triangle[order[2]];
    std::array<Vec4I, 3> tets{Vec4I(a[x], a[y], a[z], b[z]), Vec4I(a[x], a[y], b[y], b[z]),
                              Vec4I(a[x], b[x], b[y], b[z])};
    // Of the six orders just the three rotations of 0, 1, 2 are even, and in them alone the second
    // entry follows the first.
    const bool even = (order[0] + 1) % 3 == order[1];
    if (even) {
        std::swap(tets[0][1], tets[0][2]);
        std::swap(tets[2][2], tets[2][3]);
    } else {
        std::swap(tets[1][2], tets[1][3]);
    }
    return tets;
}

void append_tets(const PrismShell& layer, const PrismSplit& split, const Flags& pinned,
                 const PointIndex& outer, const PointIndex& inner, TetMesh& mesh,
                 std::uint8_t index)
{
    assert(split.order.size() == layer.triangles.size());
    for (std::size_t t = 0; t < layer.triangles.size(); ++t) {
        const Vec3I& triangle = layer.triangles[t];
        const std::array<Vec4I, 3> tets = tets_of(triangle, split.order[t], outer, inner);
        for (std::size_t i = 0; i < 3; ++i) {
            // Tet i owns the pillar of the corner that is i-th from the end of the order. If that
            // pillar is pinned, the tet has two equal corners, and leaving it out joins its two
            // neighbours face to face (docs/theory.md, "Pins").
            if (pinned[triangle[split.order[t][2 - i]]])
                continue;
            mesh.tets.push_back(tets[i]);
            mesh.prism.push_back(static_cast<std::uint32_t>(t));
            mesh.prism_layer.push_back(index);
        }
    }
}

TetMesh tets_of_layers(const PrismShell* layers, const PrismSplit* splits, std::size_t count)
{
    std::vector<Flags> pinned;
    for (std::size_t k = 0; k < count; ++k)
        pinned.push_back(pinned_vertices(layers[k]));
    TetMesh mesh;
    const std::vector<PointIndex> index = number_points(layers, pinned, mesh);
    const std::size_t most = 3 * count * layers->triangles.size();
    mesh.tets.reserve(most);
    mesh.prism.reserve(most);
    mesh.prism_layer.reserve(most);
    for (std::size_t k = 0; k < count; ++k)
        append_tets(layers[k], splits[k], pinned[k], index[k], index[k + 1], mesh,
                    static_cast<std::uint8_t>(k));
    return mesh;
}

} // namespace

const NameTable<SplitRule>& names(SplitRule)
{
    static const NameTable<SplitRule> table{{"index", SplitRule::vertex_index},
                                            {"length-descending", SplitRule::length_descending},
                                            {"length-ascending", SplitRule::length_ascending},
                                            {"ripple", SplitRule::ripple}};
    return table;
}

OptionList describe(SplitOptions& o)
{
    return in_group(
        "Tets",
        {option("rule", o.rule, "--split", "How the prisms' diagonals are chosen"),
         option("seed", o.seed, "--ripple-seed", "Seed of the ripple method").in(Unit::seed)});
}

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
    return tets_of_layers(&shell, &split, 1);
}

TetMesh make_tets(const ShellStack& stack)
{
    assert(!stack.layers.empty() && stack.layers.size() <= ShellStack::kMostLayers);
    assert(stack.splits.size() == stack.layers.size());
    return tets_of_layers(stack.layers.data(), stack.splits.data(), stack.layers.size());
}

} // namespace vdb_shell
