// SPDX-License-Identifier: Apache-2.0

// Takes: a surface and what its shell must not meet. Gives: one mesh that bounds the solid between,
// for all stages up to the certificate, and afterwards surface and shell by themselves again. With
// the cores as part of the surface, pinned everywhere, no stage in between needs a test of its own
// for them, and the certificate speaks of them too (docs/theory.md, "Cores").

#include "vdb_shell/obstacles/join_cores.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <utility>

namespace vdb_shell
{
namespace
{

using openvdb::Vec3I;
using openvdb::Vec3s;

Vec3I renumbered(Vec3I triangle, const VertexRange& dropped)
{
    for (int k = 0; k < 3; ++k)
        // Vertices of the cores are one range, so all behind it move up by its length. Refinement
        // appends vertices of the surface behind them.
        if (triangle[k] >= dropped.first)
            triangle[k] -= dropped.count;
    return triangle;
}

/// By triangle, whether it stays.
std::vector<char> stays(const std::vector<Vec3I>& triangles, const VertexRange& cores)
{
    std::vector<char> flags;
    flags.reserve(triangles.size());
    for (const Vec3I& t : triangles) {
        assert(cores.holds(t[0]) == cores.holds(t[1]) && cores.holds(t[0]) == cores.holds(t[2]));
        flags.push_back(!cores.holds(t[0]));
    }
    return flags;
}

template <typename T>
std::vector<T> kept_of(const std::vector<T>& all, const std::vector<char>& stays)
{
    std::vector<T> kept;
    for (std::size_t i = 0; i < all.size(); ++i)
        if (stays[i])
            kept.push_back(all[i]);
    return kept;
}

bool before(const Vec3s& a, const Vec3s& b)
{
    return std::array{a[0], a[1], a[2]} < std::array{b[0], b[1], b[2]};
}

} // namespace

TriangleMesh join_cores(TriangleMesh surface, const TriangleMesh& kept_out)
{
    const auto first = std::uint32_t(surface.points.size());
    surface.points.insert(surface.points.end(), kept_out.points.begin(), kept_out.points.end());
    for (const Vec3I& t : kept_out.triangles)
        // Turned round: a core is the wall of a cavity to the solid between (docs/theory.md,
        // "Cores").
        surface.triangles.emplace_back(first + t[0], first + t[2], first + t[1]);
    return surface;
}

ShellStack join_cores(ShellStack stack, const TriangleMesh& kept_out)
{
    for (PrismShell& layer : stack.layers) {
        // The inner point of a core's vertex is the outer one: it is pinned, in every layer.
        layer.inner.insert(layer.inner.end(), kept_out.points.begin(), kept_out.points.end());
        layer.stop.resize(layer.inner.size(), StopReason::pinned);
        TriangleMesh both =
            join_cores({std::move(layer.outer), std::move(layer.triangles)}, kept_out);
        layer.outer = std::move(both.points);
        layer.triangles = std::move(both.triangles);
    }
    // Prisms of three pins have no tets, so no diagonal matters.
    for (PrismSplit& split : stack.splits)
        split.order.resize(stack.triangles().size(), {0, 1, 2});
    return stack;
}

TriangleMesh drop_cores(TriangleMesh mesh, const VertexRange& cores)
{
    mesh.triangles = kept_of(mesh.triangles, stays(mesh.triangles, cores));
    for (Vec3I& t : mesh.triangles)
        t = renumbered(t, cores);
    drop_cores(mesh.points, cores);
    return mesh;
}

ShellStack drop_cores(ShellStack stack, const VertexRange& cores)
{
    const std::vector<char> stay = stays(stack.triangles(), cores);
    for (PrismSplit& split : stack.splits)
        split.order = kept_of(split.order, stay);
    for (PrismShell& layer : stack.layers) {
        layer.triangles = kept_of(layer.triangles, stay);
        for (Vec3I& t : layer.triangles)
            t = renumbered(t, cores);
        drop_cores(layer.outer, cores);
        drop_cores(layer.inner, cores);
        if (!layer.stop.empty())
            drop_cores(layer.stop, cores);
    }
    return stack;
}

bool shares_core_point(const ShellStack& stack, const VertexRange& cores)
{
    const std::vector<Vec3s>& outer = stack.surface(0);
    const auto first = outer.begin() + std::ptrdiff_t(cores.first);
    std::vector<Vec3s> points(first, first + std::ptrdiff_t(cores.count));
    // Sorted once, and then asked for each point of each surface.
    std::sort(points.begin(), points.end(), before);
    for (std::size_t k = 0; k < stack.surfaces(); ++k)
        for (std::uint32_t v = 0; v < outer.size(); ++v)
            if (!cores.holds(v) &&
                std::binary_search(points.begin(), points.end(), stack.surface(k)[v], before))
                return true;
    return false;
}

} // namespace vdb_shell
