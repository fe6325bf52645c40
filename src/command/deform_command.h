// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdb_shell/volume/deform_volume.h"

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

struct DeformArguments {
    VolumeCall call;
    std::filesystem::path rest, posed; ///< rest empty: the posed shell's own points at rest
    bool velocity = false;             ///< also how fast the shell moves
    DeformOptions deform;
};

BoundOptions add_deform_command(CLI::App& app, DeformArguments& arguments);
FilePlan plan_deform(const DeformArguments& arguments);
int run_deform(const DeformArguments& arguments, Context& context);

} // namespace vdb_shell::command
