// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "command/bound_options.h"
#include "command/context.h"
#include "command/file_plan.h"

#include <filesystem>
#include <string>
#include <vector>

namespace vdb_shell::command
{

struct JoinArguments {
    std::vector<std::filesystem::path> parts;
    std::filesystem::path whole;
    std::string expect; ///< frames, or empty: one run without a frame
};

BoundOptions add_join_command(CLI::App& app, JoinArguments& arguments);
FilePlan plan_join(const JoinArguments& arguments);
/// Writes one manifest of all parts that are there, and prints what is done, failed and missing.
int run_join(const JoinArguments& arguments, Context& context);

} // namespace vdb_shell::command
