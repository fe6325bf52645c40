// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdb_shell/inspect/inspect_mesh.h"
#include "vdb_shell/io/read_mesh.h"

#include "command/bound_options.h"
#include "command/context.h"
#include "command/file_plan.h"
#include "command/surface_input.h"

#include <filesystem>

namespace vdb_shell::command
{

struct InspectArguments {
    std::filesystem::path preset; ///< file of options
    std::filesystem::path mesh;
    InputFormat format = InputFormat::by_extension;
    ReadOptions read;
    InspectOptions inspect;
    std::filesystem::path picture; ///< coloured mesh of the defects; empty: none
    bool no_clobber = false;
    bool json = false;
};

BoundOptions add_inspect_command(CLI::App& app, InspectArguments& arguments);

FilePlan plan_inspect(const InspectArguments& arguments);

/// Prints what stands in the way of a shell; check_failed when something does.
int run_inspect(const InspectArguments& arguments, Context& context);

} // namespace vdb_shell::command
