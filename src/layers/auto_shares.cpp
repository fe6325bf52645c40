// SPDX-License-Identifier: Apache-2.0

// Takes: a shell. Gives: how deep each of its pillars is cut. A prism has well shaped tets where it
// is about as high as its triangle's edges are long, so the depths follow the edges at each vertex,
// averaged with those of its neighbours, as a step from one pillar to the next tilts the surface
// between. Deeper layers are higher, for their triangles will have been merged. A pillar that ends
// before the cut keeps its end: the layer is pinned there, so layers end where there is no room for
// them, and the shell conforms without any search (docs/theory.md, "A piece of a prism").

#include "layers/auto_shares.h"

#include "core/parallel.h"
#include "mesh/topology.h"
#include "vdb_shell/layers/cut_layers.h"

#include <cmath>

namespace vdb_shell
{
namespace
{

using openvdb::Vec3d;
using openvdb::Vec3I;
using openvdb::Vec3s;

/// Height of the first layer in edges: that of a regular tet, which is what tapering makes of it.
constexpr double kFirstHeight = 0.8164965809277260;
/// A cut below this share of the pillar would leave less than a third of a layer under it.
constexpr double kDeepestCut = 0.75;
constexpr int kSmoothings = 2;

/// Means over the edges of triangles at each vertex.
template <class OfEdge>
std::vector<double> edge_means(const VertexTriangles& around, const std::vector<Vec3I>& triangles,
                               const OfEdge& value)
{
    std::vector<double> means(around.offset.size() - 1, 0.0);
    for_each_index(means.size(), [&](std::size_t v) {
        double sum = 0;
        for (const std::uint32_t t : around.around(v))
            for (int i = 0; i < 3; ++i)
                if (const std::uint32_t u = triangles[t][i]; u != v)
                    sum += value(v, u);
        // Each triangle has two edges at the vertex.
        const std::size_t edges = 2 * around.around(v).size();
        means[v] = edges > 0 ? sum / double(edges) : 0;
    });
    return means;
}

std::vector<double> sizes_of(const std::vector<Vec3s>& skin, const std::vector<Vec3I>& triangles)
{
    const VertexTriangles around = triangles_around_vertices(skin.size(), triangles);
    std::vector<double> size = edge_means(around, triangles, [&](std::size_t v, std::uint32_t u) {
        return (Vec3d(skin[u]) - Vec3d(skin[v])).length();
    });
    for (int i = 0; i < kSmoothings; ++i)
        size = edge_means(around, triangles, [&](std::size_t v, std::uint32_t u) {
            return 0.5 * (size[v] + size[u]);
        });
    return size;
}

} // namespace

std::vector<std::vector<double>> auto_shares(const PrismShell& shell, bool upside_down,
                                             double grading)
{
    const std::vector<double> size =
        sizes_of(upside_down ? shell.inner : shell.outer, shell.triangles);
    std::vector<std::vector<double>> shares;
    double height = kFirstHeight, depth = 0; // in edges
    for (int layer = 1; layer < kMostAutoLayers; ++layer, height *= grading) {
        depth += height;
        std::vector<double> cut(size.size(), 1.0);
        bool any = false;
        for (std::size_t v = 0; v < cut.size(); ++v) {
            const double length = shell.length(v), wanted = depth * size[v];
            if (wanted >= kDeepestCut * length)
                continue;
            cut[v] = wanted / length;
            any = true;
        }
        if (!any)
            break;
        shares.push_back(std::move(cut));
    }
    return shares;
}

} // namespace vdb_shell
