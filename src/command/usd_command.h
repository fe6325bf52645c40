// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdb_shell/houdini/usd_file.h"

#include "command/frame_files.h"

namespace vdb_shell::command
{

struct UsdArguments {
    FrameFiles frames;
    UsdOptions usd;
};

BoundOptions add_usd_command(CLI::App& app, UsdArguments& arguments);

FilePlan plan_usd(const UsdArguments& arguments);

/// Holds the shells of all frames in memory.
int run_usd(const UsdArguments& arguments, Context& context);

} // namespace vdb_shell::command
