// SPDX-License-Identifier: Apache-2.0

// Takes: prisms. Gives: the order of the corners of each prism, which fixes its diagonals, and the
// tets of that order. Any total order of all vertices makes neighbouring prisms agree, so there is
// nothing to repair afterwards (docs/theory.md, "Splits"; Dompierre, Labbe, Vallet, Camarero, "How
// to Subdivide Pyramids, Prisms and Hexahedra into Tetrahedra", 1999). No coordinate is computed or
// compared here: points are copied bit by bit, and shared_points.cpp says which vertices share one.
// The trap are those: a tet of which two corners are one point must not be made.

#include "vdb_shell/shell/tessellate.h"

#include "vdb_shell/options/option.h"
#include "vdb_shell/shell/shared_points.h"
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

/// The tet that owns the pillar of each corner, from last to first in the prism's order, so from
/// the outer to the inner triangle. Positive where the prism is not inverted: below a triangle
/// that is counter-clockwise from outside, (ax,ay,by,bz) is positive and the other two negative
/// when x,y,z is an even permutation of the corners, and the reverse when it is odd.
std::array<Vec4I, 3> tets_of(const Vec3I& triangle, const std::array<std::uint8_t, 3>& order,
                             const std::uint32_t* a, const std::uint32_t* b)
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

bool all_different(const Vec4I& tet)
{
    return tet[0] != tet[1] && tet[0] != tet[2] && tet[0] != tet[3] && tet[1] != tet[2] &&
           tet[1] != tet[3] && tet[2] != tet[3];
}

/// Corners are named by the first places of their points: outer[v] and inner[v] are those of the
/// ends of a pillar.
void append_tets(const PrismShell& layer, const PrismSplit& split, const std::uint32_t* outer,
                 const std::uint32_t* inner, std::uint8_t index, TetMesh& mesh)
{
    assert(split.order.size() == layer.triangles.size());
    for (std::size_t t = 0; t < layer.triangles.size(); ++t)
        for (const Vec4I& tet : tets_of(layer.triangles[t], split.order[t], outer, inner)) {
            // Two equal corners: the tet has collapsed onto a triangle or less, and leaving it out
            // joins its neighbours face to face (docs/theory.md, "Pins" and "Tapered shells").
            if (!all_different(tet))
                continue;
            mesh.tets.push_back(tet);
            mesh.prism.push_back(static_cast<std::uint32_t>(t));
            mesh.prism_layer.push_back(index);
        }
}

/// Replaces the places in the tets by points, which are numbered in the order of the places.
/// Places that no tet uses get none: TetMesh promises that each point is a corner of some tet.
void number_points(const PrismShell* layers, std::size_t count, TetMesh& mesh)
{
    const std::size_t vertices = layers->outer.size();
    std::vector<std::uint32_t> index((count + 1) * vertices, 0);
    for (const Vec4I& tet : mesh.tets)
        for (int corner = 0; corner < 4; ++corner)
            index[tet[corner]] = 1;
    for (std::size_t k = 0; k <= count; ++k) {
        const std::vector<openvdb::Vec3s>& points =
            k < count ? layers[k].outer : layers[count - 1].inner;
        for (std::size_t v = 0; v < vertices; ++v)
            if (index[k * vertices + v] != 0) {
                index[k * vertices + v] = static_cast<std::uint32_t>(mesh.points.size());
                mesh.points.push_back(points[v]);
                mesh.source_vertex.push_back(static_cast<std::uint32_t>(v));
                mesh.layer.push_back(static_cast<std::uint8_t>(k));
            }
    }
    for (Vec4I& tet : mesh.tets)
        for (int corner = 0; corner < 4; ++corner)
            tet[corner] = index[tet[corner]];
}

TetMesh tets_of_layers(const PrismShell* layers, const PrismSplit* splits, std::size_t count,
                       bool tapered)
{
    const std::vector<std::uint32_t> first = first_places(layers, count, tapered);
    const std::size_t vertices = layers->outer.size();
    TetMesh mesh;
    const std::size_t most = 3 * count * layers->triangles.size();
    mesh.tets.reserve(most);
    mesh.prism.reserve(most);
    mesh.prism_layer.reserve(most);
    for (std::size_t k = 0; k < count; ++k)
        append_tets(layers[k], splits[k], first.data() + k * vertices,
                    first.data() + (k + 1) * vertices, static_cast<std::uint8_t>(k), mesh);
    number_points(layers, count, mesh);
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
    return in_group("Tets",
                    {option("rule", o.rule, "--split", "How the prisms' diagonals are chosen"),
                     option("seed", o.seed, "--ripple-seed", "Seed of the ripple method")
                         .needing("--split ripple")
                         .in(Unit::seed)});
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
    return tets_of_layers(&shell, &split, 1, false);
}

TetMesh make_tets(const ShellStack& stack)
{
    assert(!stack.layers.empty() && stack.layers.size() <= ShellStack::kMostLayers);
    assert(stack.splits.size() == stack.layers.size());
    return tets_of_layers(stack.layers.data(), stack.splits.data(), stack.layers.size(),
                          stack.tapered);
}

double tet_volume(const TetMesh& mesh, std::size_t first_layer)
{
    // In one thread, so that the last bit of the sum does not depend on the number of threads.
    double six_volumes = 0;
    for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
        if (first_layer > 0 && mesh.prism_layer[t] < first_layer)
            continue; // tets of no layers have no list of them
        const openvdb::Vec4I& tet = mesh.tets[t];
        // Relative to the tet's own first corner: differences of near float32 points are exact in
        // doubles, so the volume is as accurate far from the origin.
        const openvdb::Vec3d a(mesh.points[tet[0]]);
        const openvdb::Vec3d ab = openvdb::Vec3d(mesh.points[tet[1]]) - a;
        const openvdb::Vec3d ac = openvdb::Vec3d(mesh.points[tet[2]]) - a;
        const openvdb::Vec3d ad = openvdb::Vec3d(mesh.points[tet[3]]) - a;
        six_volumes += ab.cross(ac).dot(ad);
    }
    return six_volumes / 6;
}

} // namespace vdb_shell
