// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "command/frame_files.h"

namespace vdb_shell::command
{

using PageArguments = FrameFiles;

BoundOptions add_page_command(CLI::App& app, PageArguments& arguments);

FilePlan plan_page(const PageArguments& arguments);

/// Holds one shell in memory at a time, and the page.
int run_page(const PageArguments& arguments, Context& context);

} // namespace vdb_shell::command
