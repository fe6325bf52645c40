// SPDX-License-Identifier: Apache-2.0

// Takes: a shell. Gives: one of its surfaces, for the formats that hold nothing but triangles.

#include "vdb_shell/write/surface_file.h"

#include "vdb_shell/shell/shared_points.h"

namespace vdb_shell
{

const NameTable<ShellSurface>& names(ShellSurface)
{
    static const NameTable<ShellSurface> table{{"grown", ShellSurface::grown},
                                               {"skin", ShellSurface::skin}};
    return table;
}

OptionList describe(SurfaceFileOptions& o)
{
    return in_group(
        "Output",
        {option("surface", o.surface, "--surface",
                "What a file of triangles holds: the surface that was grown (the inner one; of an "
                "outward shell the outer one), or the skin that the shell stands on, as it was "
                "mended, wrapped or remeshed")
             .needing("--output .obj .ply .off .stl")});
}

TriangleMesh surface_of(const ShellStack& stack, ShellSurface which)
{
    if (which == ShellSurface::skin)
        return skin_surface(stack);
    const bool outward = stack.skin == stack.layers.size();
    return outward ? TriangleMesh{stack.surface(0), stack.triangles()} : inner_surface(stack);
}

} // namespace vdb_shell
