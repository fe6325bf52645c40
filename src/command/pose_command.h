// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdb_shell/io/read_mesh.h"
#include "vdb_shell/pose/pose_shell.h"

#include "command/bound_options.h"
#include "command/outputs.h"

#include <filesystem>

namespace vdb_shell::command
{

struct PoseArguments {
    std::filesystem::path shell, mesh;
    std::filesystem::path rest_mesh; ///< empty: `mesh` has the triangles of the shell's surface
    std::filesystem::path preset, report;
    PoseOptions pose;
    Outputs outputs;
    bool quiet = false, progress = false;
};

BoundOptions add_pose_command(CLI::App& app, PoseArguments& arguments);
int run_pose(const PoseArguments& arguments);

} // namespace vdb_shell::command
