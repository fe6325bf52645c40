// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdb_shell/io/read_mesh.h"
#include "vdb_shell/pipeline.h"

#include "command/bound_options.h"
#include "command/context.h"
#include "command/outputs.h"
#include "command/purpose.h"
#include "command/surface_input.h"

#include <filesystem>
#include <string>
#include <vector>

namespace vdb_shell::command
{

struct BuildArguments {
    Purpose purpose = Purpose::any;
    std::filesystem::path preset; ///< file of options
    std::filesystem::path mesh;   ///< or a level set: FILE.vdb or FILE.vdb:GRID
    InputFormat format = InputFormat::by_extension;
    ReadOptions read;
    ShellOptions shell;
    std::string thickness_grid;     ///< FILE.vdb or FILE.vdb:GRID
    std::vector<std::string> cores; ///< files of --core
    Outputs outputs;
    std::filesystem::path report;
    std::filesystem::path remesh_map;
    bool quiet = false;
};

/// All that the command can be given, and that a file of options can have.
OptionSections describe(BuildArguments& arguments);

BoundOptions add_build_command(CLI::App& app, BuildArguments& arguments);

/// All that can be refused before anything is read is refused here.
FilePlan plan_build(const BuildArguments& arguments);

/// Reads, builds, writes; prints the figures. Throws what the stages throw.
int run_build(const BuildArguments& arguments, Context& context);

} // namespace vdb_shell::command
