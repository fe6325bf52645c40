// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdb_shell/io/read_mesh.h"
#include "vdb_shell/pose/pose_shell.h"

#include "command/bound_options.h"
#include "command/context.h"
#include "command/file_plan.h"
#include "command/outputs.h"
#include "command/surface_input.h"

#include <filesystem>

namespace vdb_shell::command
{

struct PoseArguments {
    std::filesystem::path shell, mesh;
    std::filesystem::path rest_mesh;     ///< empty: `mesh` has the triangles of the shell's surface
    std::filesystem::path before, after; ///< meshes of the neighbouring frames; may not be there
    double frame_seconds = 1.0 / 24;     ///< from one frame to the next
    InputFormat format = InputFormat::by_extension; ///< of `mesh`
    std::filesystem::path preset, report;
    PoseOptions pose;
    Outputs outputs;
    bool quiet = false;
};

BoundOptions add_pose_command(CLI::App& app, PoseArguments& arguments);
/// All that can be refused before anything is read is refused here.
FilePlan plan_pose(const PoseArguments& arguments);
/// Reads, poses, writes; prints the figures. Throws what the stages throw.
int run_pose(const PoseArguments& arguments, Context& context);

} // namespace vdb_shell::command
