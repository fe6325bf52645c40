// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdb_shell/volume/map_volume.h"

#include "command/bound_options.h"
#include "command/context.h"
#include "command/file_plan.h"

#include <filesystem>
#include <string>
#include <vector>

namespace CLI
{
class App;
}

namespace vdb_shell::command
{

struct MapArguments {
    std::filesystem::path volume, shell, mesh, output;
    std::vector<std::string> grids; ///< empty: all
    std::filesystem::path report;
    MapOptions map;
    bool quiet = false, no_clobber = false;
};

BoundOptions add_map_command(CLI::App& app, MapArguments& arguments);
FilePlan plan_map(const MapArguments& arguments);
int run_map(const MapArguments& arguments, Context& context);

} // namespace vdb_shell::command
