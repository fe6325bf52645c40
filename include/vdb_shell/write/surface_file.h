// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdb_shell/options/option.h"
#include "vdb_shell/shell/shell_stack.h"

namespace vdb_shell
{

/// Which surface of a shell a file of triangles holds.
enum class ShellSurface {
    grown, ///< the inner one; of an outward shell the outermost
    skin,  ///< the one that the shell stands on: the input, as it was mended, wrapped or remeshed
};
const NameTable<ShellSurface>& names(ShellSurface);

struct SurfaceFileOptions {
    ShellSurface surface = ShellSurface::grown;
};
OptionList describe(SurfaceFileOptions& options);

/// The skin has all points of the shell's surface in their order, so moved copies of it are poses
/// for pose_shell(). Of a tapered shell what was grown inward is as inner_surface() has it
/// (vdb_shell/shell/shared_points.h), which may be empty.
TriangleMesh surface_of(const ShellStack& stack, ShellSurface which);

} // namespace vdb_shell
