// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdb_shell/io/read_mesh.h"
#include "vdb_shell/repair/repair_mesh.h"

#include <filesystem>
#include <string>

namespace CLI
{
class App;
}

namespace vdb_shell::command
{

/// Binds the fields that `build --repair` and `repair` have in common.
void add_repair_options(CLI::App& app, RepairOptions& options, const std::string& group);

struct RepairArguments {
    std::filesystem::path mesh, output;
    ReadOptions read;
    RepairOptions repair;
    bool json = false;
};

void add_repair_command(CLI::App& app, RepairArguments& arguments);

/// Writes the repaired mesh and prints every change; check_failed when something still stands in
/// the way of a shell.
int run_repair(const RepairArguments& arguments);

} // namespace vdb_shell::command
