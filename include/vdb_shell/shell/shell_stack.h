// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdb_shell/shell/tessellate.h"

#include <cstddef>
#include <vector>

namespace vdb_shell
{

/// Shells of the same triangles on top of each other: n layers between the n + 1 surfaces S_0, the
/// outermost, to S_n, the innermost. Layer k lies between S_k (its `outer`) and S_k+1 (its
/// `inner`); layers[k].inner is layers[k + 1].outer bit for bit, and `triangles` are the same in
/// all. A vertex may be pinned in some layers and not in others. The diagonals of different layers
/// have nothing to do with each other.
struct ShellStack {
    /// The most layers that the index of a surface has room for.
    static constexpr std::size_t kMostLayers = 250;

    std::vector<PrismShell> layers; ///< from the outermost to the innermost
    std::vector<PrismSplit> splits; ///< one for each layer
    /// The surface that is the user's input: 0 where the shell lies inside, n where it lies
    /// outside, in between where it lies on both sides.
    std::size_t skin = 0;
    /// Whether vertices may share inner points. If so, points that are equal, on whatever surfaces
    /// and of whatever vertices, are one point: several pillars may end in it, and a pillar may end
    /// in the outer point of another vertex. If not, only the two ends of a pinned pillar are one
    /// (shell/shared_points.h; docs/theory.md, "Tapered shells").
    bool tapered = false;

    std::size_t surfaces() const { return layers.size() + 1; }
    /// S_k. Precondition: k < surfaces(), at least one layer.
    const std::vector<openvdb::Vec3s>& surface(std::size_t k) const
    {
        return k < layers.size() ? layers[k].outer : layers.back().inner;
    }
    const std::vector<openvdb::Vec3I>& triangles() const { return layers.front().triangles; }
};

/// A stack of one layer below the surface.
ShellStack one_layer(PrismShell shell, PrismSplit split);

/// The surface that the shell stands on, with all its points in their order.
TriangleMesh skin_surface(const ShellStack& stack);

/// S_0 and S_n as one shell, with the diagonals' choice left to the caller: what the stack looks
/// like from both sides. `stop` is that of the layer that ends the pillar: the innermost, or the
/// outermost where all layers lie above the skin.
PrismShell hull_of(const ShellStack& stack);

/// Of the whole pillar, along its layers: the sum over them and not the distance of the two ends,
/// for on both sides of the skin the pillar may have a bend.
double pillar_length(const ShellStack& stack, std::size_t vertex);

/// As make_tets of one shell, layer after layer. A point for each surface and vertex, in that
/// order; where a pillar is pinned in a layer, its point is that of the surface above
/// (TetMesh::layer is the first of the surfaces that share it). Tets of neighbouring layers meet
/// face to face: both have the triangles of the surface between them. A stack of one layer gives
/// the tets of its shell. Of a tapered stack: tets whose four corners are four points, and a point
/// has the surface and the vertex of the first place that shares it.
TetMesh make_tets(const ShellStack& stack);

} // namespace vdb_shell
