// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdb_shell/mesh/placement.h"
#include "vdb_shell/shell/shell_stack.h"

#include "command/surface_input.h"

#include <openvdb/Types.h>

#include <filesystem>
#include <vector>

namespace vdb_shell::command
{

struct PosedSurface {
    std::filesystem::path mesh;
    InputFormat format = InputFormat::by_extension;
    std::filesystem::path rest_mesh; ///< may be empty
};

/// The surface of the shell in the pose, vertex by vertex, in the frame of the shell: from a mesh
/// of the same triangles, or of the same polygons; else from one whose points have ids; both of the
/// shell's own surface, or of the rest mesh, to which the shell's vertices are then tied. `shell`:
/// for messages. Throws InvalidOption where neither holds, and what readers throw.
std::vector<openvdb::Vec3s> read_posed_skin(const PosedSurface& posed, const ShellStack& at_rest,
                                            const Placement& placement,
                                            const std::filesystem::path& shell);

} // namespace vdb_shell::command
