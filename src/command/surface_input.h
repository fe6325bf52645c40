// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdb_shell/core/grid_types.h"
#include "vdb_shell/io/read_mesh.h"
#include "vdb_shell/mesh/placement.h"
#include "vdb_shell/options/section.h"

#include "command/context.h"

#include <filesystem>
#include <string>

namespace vdb_shell::command
{

/// Extensions that read_surface knows, for the help.
inline constexpr const char* kSurfaceExtensions =
    ".obj .ply .off .stl .geo .bgeo .bgeo.sc, or - (standard input)";

/// FILE.vdb or FILE.vdb:GRID.
struct GridName {
    std::string file, grid;
};

GridName split_grid_name(const std::string& name);

/// What standard input holds, which has no name whose extension would say so.
enum class InputFormat { by_extension, obj, ply, off, stl, geo, bgeo };
const NameTable<InputFormat>& names(InputFormat);

Option input_format_option(InputFormat& format);

/// Throws InvalidOption where standard input is to be read and no format is given, and the other
/// way round.
void require_format(const std::filesystem::path& path, InputFormat format);

/// The triangles of any file that can have some, Houdini's included, and of standard input (-).
ReadResult read_surface(const std::filesystem::path& path, const ReadOptions& options,
                        InputFormat format = InputFormat::by_extension);

/// Lengths on the command line are in the file's unit; the stages work in the mesh's.
template <typename Options> Options in_unit(Options options, double unit)
{
    auto described = describe(options);
    divide_lengths(described, unit);
    return options;
}

/// The grid where the mesh is. Null stays null.
FloatGridPtr in_place(const FloatGridPtr& grid, const Placement& placement);

/// Says where reading lost digits that --recentre would keep.
void warn_of_lost_digits(const std::filesystem::path& path, const ReadResult& read,
                         const Context& context);

} // namespace vdb_shell::command
