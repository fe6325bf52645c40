// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "command/build_command.h"

#include <string>
#include <vector>

namespace vdb_shell::command
{

struct EstimateArguments {
    std::vector<std::string> words; ///< surfaces; or, behind --, the words of one call
    BuildArguments build;           ///< of the surfaces: its mesh is each of them in turn
};

BoundOptions add_estimate_command(CLI::App& app, EstimateArguments& arguments);
FilePlan plan_estimate(const EstimateArguments& arguments);
/// Reads the inputs and prints what the calls would cost; makes nothing.
int run_estimate(const EstimateArguments& arguments, Context& context);

} // namespace vdb_shell::command
