// SPDX-License-Identifier: Apache-2.0

// Takes a surface and marks on its edges, halves these edges and cuts the triangles around them.
// The result conforms without any search, because a mark belongs to the edge and both triangles see
// the same middle. A middle is computed once, in doubles, and rounded to float32; so the shape
// moves by that rounding, and tiny triangles may become flat or touch others, which callers have to
// test. Triangles with one, two or three marks give two, three or four pieces.

#include "resample/edge_split.h"

#include "mesh/topology.h"

#include <cassert>

namespace vdb_shell
{
namespace
{

using openvdb::Vec3d;
using openvdb::Vec3I;
using openvdb::Vec3s;

constexpr std::uint32_t kNoPoint = ~std::uint32_t(0);

/// A triangle's corners and the middles of its sides, kNoPoint where a side stays whole.
struct MarkedTriangle {
    std::array<std::uint32_t, 3> corner, middle;
};

/// The same triangle with side `first` as side 0. It is turned and not mirrored, so its pieces are
/// oriented as it was.
MarkedTriangle turned(const MarkedTriangle& t, std::size_t first)
{
    MarkedTriangle out{};
    for (std::size_t k = 0; k < 3; ++k) {
        out.corner[k] = t.corner[(first + k) % 3];
        out.middle[k] = t.middle[(first + k) % 3];
    }
    return out;
}

/// Cuts at the middle of side 0 first. With two marks this decides the diagonal of the
/// quadrilateral that is left, which the marks alone would leave open.
template <typename Add> void cut(const MarkedTriangle& t, const Add& add)
{
    const auto [a, b, c] = t.corner;
    const auto [ab, bc, ca] = t.middle;
    assert(ab != kNoPoint);
    if (bc != kNoPoint && ca != kNoPoint) {
        add(a, ab, ca);
        add(ab, b, bc);
        add(ca, bc, c);
        add(ab, bc, ca);
        return;
    }
    if (ca == kNoPoint) {
        add(a, ab, c);
    } else {
        add(a, ab, ca);
        add(ca, ab, c);
    }
    if (bc == kNoPoint) {
        add(ab, b, c);
    } else {
        add(ab, b, bc);
        add(ab, bc, c);
    }
}

} // namespace

EdgeList edges_of(const std::vector<Vec3I>& triangles)
{
    EdgeList list;
    list.triangles.resize(triangles.size());
    // Uses of one edge stand together, so each edge is entered once, and edges ascend.
    for (const EdgeUse& use : sorted_edge_uses(triangles)) {
        if (list.ends.empty() || list.ends.back() != use.edge)
            list.ends.push_back(use.edge);
        list.triangles[use.triangle][use.side] = static_cast<std::uint32_t>(list.ends.size() - 1);
    }
    return list;
}

EdgeSplit split_edges(const TriangleMesh& mesh, const EdgeList& edges,
                      const std::vector<char>& marked, const std::vector<std::uint8_t>& first_cut)
{
    EdgeSplit out;
    out.mesh.points = mesh.points;
    std::vector<std::uint32_t> middle(edges.ends.size(), kNoPoint);
    for (std::uint32_t e = 0; e < middle.size(); ++e) {
        if (!marked[e])
            continue;
        middle[e] = static_cast<std::uint32_t>(out.mesh.points.size());
        const Vec3d a(mesh.points[edges.ends[e][0]]), b(mesh.points[edges.ends[e][1]]);
        out.mesh.points.emplace_back(0.5 * (a + b));
        out.edge.push_back(e);
    }
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
        MarkedTriangle triangle{};
        bool whole = true;
        for (std::size_t k = 0; k < 3; ++k) {
            triangle.corner[k] = mesh.triangles[t][static_cast<int>(k)];
            triangle.middle[k] = middle[edges.triangles[t][k]];
            whole &= triangle.middle[k] == kNoPoint;
        }
        const auto add = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
            out.mesh.triangles.emplace_back(a, b, c);
            out.source.push_back(t);
        };
        if (whole)
            add(triangle.corner[0], triangle.corner[1], triangle.corner[2]);
        else
            cut(turned(triangle, first_cut[t]), add);
    }
    return out;
}

} // namespace vdb_shell
