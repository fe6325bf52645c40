// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdb_shell/volume/map_volume.h"

#include "command/bound_options.h"
#include "command/context.h"
#include "command/volume_call.h"

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
    VolumeCall call;
    std::filesystem::path shell, mesh;
    MapOptions map;
};

BoundOptions add_map_command(CLI::App& app, MapArguments& arguments);
FilePlan plan_map(const MapArguments& arguments);
int run_map(const MapArguments& arguments, Context& context);

} // namespace vdb_shell::command
