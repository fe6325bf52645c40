// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdb_shell/volume/deform_volume.h"

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

struct DeformArguments {
    std::filesystem::path volume, output;
    std::filesystem::path rest, posed; ///< rest empty: the posed shell's own points at rest
    std::vector<std::string> grids;    ///< empty: all
    std::filesystem::path report;
    DeformOptions deform;
    bool quiet = false, no_clobber = false;
};

BoundOptions add_deform_command(CLI::App& app, DeformArguments& arguments);
FilePlan plan_deform(const DeformArguments& arguments);
int run_deform(const DeformArguments& arguments, Context& context);

} // namespace vdb_shell::command
