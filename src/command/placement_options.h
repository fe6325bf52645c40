// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdb_shell/io/read_mesh.h"
#include "vdb_shell/pipeline.h"

#include <openvdb/openvdb.h>

#include <filesystem>
#include <string>

namespace CLI
{
class App;
}

namespace vdb_shell::command
{

/// --recentre and --rescale, for every command that reads a mesh.
void add_placement_options(CLI::App& app, ReadOptions& read, const std::string& group);

// Lengths on the command line are in the file's unit; the stages work in the mesh's.
ShellOptions in_unit(ShellOptions options, double unit);
RepairOptions in_unit(RepairOptions options, double unit);
LevelSetOptions in_unit(LevelSetOptions options, double unit);
/// The grid where the mesh is. Null stays null.
openvdb::FloatGrid::Ptr in_place(const openvdb::FloatGrid::Ptr& grid, const Placement& placement);

/// On standard error, where reading lost digits that --recentre would keep.
void warn_of_lost_digits(const std::filesystem::path& path, const ReadResult& read);

} // namespace vdb_shell::command
