// SPDX-License-Identifier: Apache-2.0

// Takes: a surface, or a shell that was grown under the reversed surface. Gives: the reversed
// surface, or the shell as a shell above the surface itself. Growth knows one side only, the one
// behind the triangles; an outward shell is made by turning the triangles round before it and
// turning the result back after it (docs/theory.md, "Outward shells, and shells on both sides", and
// "Turning back"). Points are moved from list to list and never computed, so every tet stays the
// same set of float32 points. The trap is the split: its corners are places in a triangle, so they
// have to be renamed when the triangle is turned, not only reversed.

#include "vdb_shell/shell/sides.h"

#include <cassert>
#include <utility>

namespace vdb_shell
{
namespace
{

/// The place of a triangle's corner after the second and the third have been exchanged.
std::uint8_t exchanged(std::uint8_t corner)
{
    return static_cast<std::uint8_t>((3 - corner) % 3);
}

/// The grown surface becomes the outer one. Reasons to stop belong to vertices and stay where they
/// are.
PrismShell turned(const PrismShell& layer)
{
    return {layer.inner, layer.outer, reversed_surface({{}, layer.triangles}).triangles,
            layer.stop};
}

/// The tets (ax,ay,az,bz), (ax,ay,by,bz), (ax,bx,by,bz) with a and b exchanged are those of the
/// order z, y, x. So no diagonal changes, and a prism that was certified for its three chosen tets
/// alone stays what it was.
PrismSplit turned(const PrismSplit& split)
{
    PrismSplit result = split;
    for (auto& [x, y, z] : result.order) {
        const std::uint8_t first = exchanged(z), last = exchanged(x);
        x = first;
        y = exchanged(y);
        z = last;
    }
    return result;
}

} // namespace

const NameTable<Side>& names(Side)
{
    static const NameTable<Side> table{
        {"inward", Side::inward}, {"outward", Side::outward}, {"both", Side::both}};
    return table;
}

TriangleMesh reversed_surface(TriangleMesh mesh)
{
    for (openvdb::Vec3I& t : mesh.triangles)
        std::swap(t[1], t[2]);
    return mesh;
}

double default_outward_thickness(const TriangleMesh& mesh)
{
    return kOutwardShare * diagonal_of(bounds_of(mesh.points));
}

ShellStack turn_back(const ShellStack& reversed)
{
    assert(reversed.skin == 0 && reversed.splits.size() == reversed.layers.size());
    ShellStack stack;
    // Seen from the reversed surface the layers run outward, so the last of them is the outermost
    // one of the stack.
    for (std::size_t k = reversed.layers.size(); k-- > 0;) {
        stack.layers.push_back(turned(reversed.layers[k]));
        stack.splits.push_back(turned(reversed.splits[k]));
    }
    stack.skin = stack.layers.size();
    return stack;
}

ShellStack join_sides(ShellStack outside, ShellStack inside)
{
    assert(outside.skin == outside.layers.size() && inside.skin == 0);
    // Neither reversing a surface nor growing under it moves an outer point, so both sides have the
    // skin bit by bit, and its points are numbered once.
    assert(outside.layers.back().inner == inside.layers.front().outer);
    assert(outside.triangles() == inside.triangles());
    for (std::size_t k = 0; k < inside.layers.size(); ++k) {
        outside.layers.push_back(std::move(inside.layers[k]));
        outside.splits.push_back(std::move(inside.splits[k]));
    }
    return outside;
}

} // namespace vdb_shell
