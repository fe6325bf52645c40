// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "command/build_command.h"

#include <filesystem>
#include <vector>

namespace vdb_shell::command
{

struct EstimateArguments {
    std::vector<std::filesystem::path> meshes;
    BuildArguments build; ///< its mesh is each of them in turn
};

BoundOptions add_estimate_command(CLI::App& app, EstimateArguments& arguments);
FilePlan plan_estimate(const EstimateArguments& arguments);
/// Reads the surfaces and prints what shells of them would cost; makes none.
int run_estimate(const EstimateArguments& arguments, Context& context);

} // namespace vdb_shell::command
