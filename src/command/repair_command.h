// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdb_shell/io/read_mesh.h"
#include "vdb_shell/repair/repair_mesh.h"

#include "command/bound_options.h"
#include "command/context.h"
#include "command/file_plan.h"
#include "command/surface_input.h"

#include <filesystem>

namespace vdb_shell::command
{

struct RepairArguments {
    std::filesystem::path preset; ///< file of options
    std::filesystem::path mesh, output;
    InputFormat format = InputFormat::by_extension;
    ReadOptions read;
    RepairOptions repair;
    bool no_clobber = false;
    bool json = false, quiet = false;
};

BoundOptions add_repair_command(CLI::App& app, RepairArguments& arguments);

FilePlan plan_repair(const RepairArguments& arguments);

/// Writes the repaired mesh and prints every change; check_failed when something still stands in
/// the way of a shell.
int run_repair(const RepairArguments& arguments, Context& context);

} // namespace vdb_shell::command
