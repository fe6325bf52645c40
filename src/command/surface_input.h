// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdb_shell/core/grid_types.h"
#include "vdb_shell/io/read_mesh.h"
#include "vdb_shell/mesh/placement.h"
#include "vdb_shell/options/section.h"

#include <filesystem>
#include <string>

namespace vdb_shell::command
{

/// Extensions that read_surface knows, for the help.
inline constexpr const char* kSurfaceExtensions = ".obj .ply .off .stl .geo .bgeo .bgeo.sc";

/// FILE.vdb or FILE.vdb:GRID.
struct GridName {
    std::string file, grid;
};

GridName split_grid_name(const std::string& name);

/// The triangles of any file that can have some, Houdini's included.
ReadResult read_surface(const std::filesystem::path& path, const ReadOptions& options);

/// Lengths on the command line are in the file's unit; the stages work in the mesh's.
template <typename Options> Options in_unit(Options options, double unit)
{
    auto described = describe(options);
    divide_lengths(described, unit);
    return options;
}

/// The grid where the mesh is. Null stays null.
FloatGridPtr in_place(const FloatGridPtr& grid, const Placement& placement);

/// On standard error, where reading lost digits that --recentre would keep.
void warn_of_lost_digits(const std::filesystem::path& path, const ReadResult& read);

} // namespace vdb_shell::command
