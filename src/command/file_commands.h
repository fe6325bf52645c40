// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "command/bound_options.h"
#include "command/context.h"
#include "command/outputs.h"

#include <filesystem>

namespace CLI
{
class App;
}

// The commands that work on a shell's .vdb: info, convert, check.

namespace vdb_shell::command
{

struct FileArguments {
    std::filesystem::path file;
    Outputs outputs;   ///< convert only
    bool json = false; ///< info only: the stored parameters and report as JSON
};

BoundOptions add_info_command(CLI::App& app, FileArguments& arguments);
BoundOptions add_convert_command(CLI::App& app, FileArguments& arguments);
BoundOptions add_check_command(CLI::App& app, FileArguments& arguments);

/// A .vdb or Houdini geometry; the grids are null when the file has none.
ShellFile read_shell(const std::filesystem::path& path);

/// Adds the file of the shell's points where they are not in its own, which only that one says.
/// Throws what opening it throws.
void add_points_file(FilePlan& plan, const std::filesystem::path& shell);

FilePlan plan_convert(const FileArguments& arguments);

int run_info(const FileArguments& arguments, Context& context);
int run_convert(const FileArguments& arguments);

/// Prints one line for each thing verified; check_failed when one of them does not hold.
int run_check(const FileArguments& arguments, Context& context);

} // namespace vdb_shell::command
