// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdb_shell/volume/coordinate_grids.h"

#include "command/bound_options.h"
#include "command/context.h"
#include "command/file_plan.h"

#include <filesystem>

namespace CLI
{
class App;
}

namespace vdb_shell::command
{

struct VolumesArguments {
    std::filesystem::path shell, output;
    std::filesystem::path texture; ///< the surface with texture coordinates, for uvw
    CoordinateOptions coordinates;
    bool half = false, no_clobber = false;
};

BoundOptions add_volumes_command(CLI::App& app, VolumesArguments& arguments);
FilePlan plan_volumes(const VolumesArguments& arguments);
int run_volumes(const VolumesArguments& arguments, Context& context);

} // namespace vdb_shell::command
