// SPDX-License-Identifier: Apache-2.0

// Takes a shell's file, gives the shell at rest, whether the file has it posed or not.

#include "vdb_shell/write/vdb_file.h"

namespace vdb_shell
{

/// Places alone change: triangles, splits and reasons are those of every pose.
ShellStack rest_stack(const ShellFile& file)
{
    ShellStack stack = file.stack;
    for (std::size_t k = 0; file.rest.posed() && k < stack.layers.size(); ++k) {
        stack.layers[k].outer = file.rest.surface[k];
        stack.layers[k].inner = file.rest.surface[k + 1];
    }
    return stack;
}

CoreTets rest_core(const ShellFile& file)
{
    CoreTets core = file.core;
    if (file.rest.posed())
        core.points = file.rest.core;
    return core;
}

RestPoints rest_points(const ShellFile& file)
{
    if (file.rest.posed())
        return file.rest;
    RestPoints rest;
    for (std::size_t k = 0; k < file.stack.surfaces(); ++k)
        rest.surface.push_back(file.stack.surface(k));
    rest.core = file.core.points;
    return rest;
}

} // namespace vdb_shell
