// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdb_shell/core/interrupter.h"
#include "vdb_shell/shell/tessellate.h"

#include <openvdb/openvdb.h>

#include <filesystem>
#include <optional>
#include <string>

namespace vdb_shell
{

/// Version of the layout in docs/file_format.md. A reader refuses a larger one.
inline constexpr int kShellSchema = 1;

/// All that a shell's .vdb holds.
struct ShellFile {
    openvdb::FloatGrid::Ptr surface; ///< the level set
    openvdb::FloatGrid::Ptr depth;   ///< see shell_depth_grid
    PrismShell shell;
    PrismSplit split;
    TetMesh tets;
    std::string parameters_json;
    std::string report_json;
};

enum class PointPlacement {
    same_file, ///< level set and point grids in one file
    beside, ///< point grids in NAME.points.vdb, so that a reader without point grids can read all
            ///< of NAME.vdb
};

struct VdbWriteOptions {
    PointPlacement points = PointPlacement::same_file;
};

/// Float grid "depth" over the voxels whose centres lie in a tet: 0 on the outer surface, 1 on the
/// inner one, linear in each tet; where tets overlap, the one of smallest index. Class fog volume,
/// background 0. Same bits for any number of threads. Throws Cancelled.
openvdb::FloatGrid::Ptr shell_depth_grid(const TetMesh& tets, double voxel_size,
                                         Interrupter* interrupter = nullptr);

/// Writes grids and metadata as docs/file_format.md says. Throws WriteError.
void write_shell_vdb(const std::filesystem::path& path, const ShellFile& file,
                     const VdbWriteOptions& options = {});

/// Reads what write_shell_vdb wrote, bit for bit; finds points that stand beside the file. Throws
/// ReadError with file, grid, attribute and index for anything that is missing or out of range.
ShellFile read_shell_vdb(const std::filesystem::path& path);

/// A float grid of a .vdb, for painted thickness: by name, or the only float grid when `name` is
/// empty. Throws ReadError naming the grids that the file has.
openvdb::FloatGrid::Ptr read_float_grid(const std::filesystem::path& path, const std::string& name);

} // namespace vdb_shell
