// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdb_shell/core/grid_types.h"
#include "vdb_shell/core/interrupter.h"
#include "vdb_shell/mesh/placement.h"
#include "vdb_shell/obstacles/core_feet.h"
#include "vdb_shell/options/describe.h"
#include "vdb_shell/shell/core_tets.h"
#include "vdb_shell/shell/shell_stack.h"
#include "vdb_shell/write/input_points.h"
#include "vdb_shell/write/shell_points.h"

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace vdb_shell
{
class OutputSet;

/// Version of the layout in docs/file_format.md. A reader refuses a larger one. A shell of one
/// layer below its surface is written as schema 1, which has no words for layers; one that is not
/// tapered as schema 2 at most, one without a core as schema 3 at most, one at rest as schema 4 at
/// most.
inline constexpr int kShellSchema = 5;
inline constexpr int kLayeredSchema = 2; ///< the first that knows layers
inline constexpr int kTaperedSchema = 3; ///< the first that knows pillars with a common end
inline constexpr int kFilledSchema = 4;  ///< the first that knows tets of a core
inline constexpr int kPosedSchema = 5;   ///< the first that knows where points were at rest
/// The oldest schema that has words for the shell. Files of one layer below the surface say nothing
/// of layers.
int schema_for(const ShellCounts& counts);
/// PrismSplit::ripples of all layers.
std::size_t ripples_of(const ShellStack& stack);

/// All that a shell's .vdb holds.
struct ShellFile {
    FloatGridPtr surface; ///< the level set
    FloatGridPtr depth;   ///< see shell_depth_grid
    ShellStack stack;
    TetMesh tets;
    std::string parameters_json;
    std::string report_json;
    /// Of the surface that was read. In memory grids and points are about the mesh's origin; in the
    /// .vdb the transforms of the grids put them where the file has them, in the mesh's unit.
    Placement placement{};
    std::vector<CoreFoot> core_feet{}; ///< by vertex; empty where there were no cores
    CoreTets core{};                   ///< empty where nothing fills the shell
    RestPoints rest{};                 ///< of a posed shell
    InputPoints input{};               ///< of the surface before remeshing; empty where it was not
    GridBasePtr rest_volume{};         ///< written if there is one; not read
    GridBasePtr velocity_volume{};     ///< the same
    /// Digests of parts of the file that held when it was read; 0 where it has none.
    std::size_t digests = 0;
};

enum class PointPlacement {
    same_file, ///< level set and point grids in one file
    beside, ///< point grids in NAME.points.vdb, so that a reader without point grids can read all
            ///< of NAME.vdb
};
const NameTable<PointPlacement>& names(PointPlacement);

struct VdbWriteOptions {
    PointPlacement points = PointPlacement::same_file;
    /// Save "surface" and "depth" with half floats: eleven bits of precision. The shell itself
    /// stays exact.
    bool half = false;
};
OptionList describe(VdbWriteOptions& options);

/// What a shell's .vdb says about itself, without its grids.
struct ShellInfo {
    int schema = 0;
    std::int64_t vertices = 0; ///< of the surface
    std::int64_t points = 0;   ///< vertices and, layer by layer, the lower ends of all pillars that
                               ///< have a length
    std::int64_t tet_points = 0, prisms = 0, tets = 0;
    std::int64_t layers = 1; ///< as many prisms stand on top of each other
    std::int64_t skin = 0;   ///< ShellStack::skin
    bool tapered = false;    ///< ShellStack::tapered
    std::int64_t core_points = 0, core_tets = 0;
    std::int64_t input_points = 0;   ///< ShellFile::input
    bool posed = false;              ///< ShellFile::rest.posed()
    Placement placement;             ///< moves nothing where the file has none
    std::int64_t ripples = 0;        ///< PrismSplit::ripples, of all layers
    std::string creator;             ///< program and version that wrote it
    std::string orientation;         ///< how triangles and tets are oriented, in words
    std::string checksum;            ///< of the shell's arrays: 16 hexadecimal digits
    std::vector<std::string> grids;  ///< names of all grids, those beside the file included
    std::filesystem::path points_at; ///< the file that has the point grids
    std::string parameters_json;
    std::string report_json;
};

/// The shell of the file, or where it is posed that at rest.
ShellStack rest_stack(const ShellFile& file);
CoreTets rest_core(const ShellFile& file);
RestPoints rest_points(const ShellFile& file);

/// Float grid "depth" over the voxels whose centres lie in a tet: 0 on the outer surface, 1 on the
/// inner one, linear in each tet (with n layers, k / n on surface k); where tets overlap, the one
/// of smallest index. Class fog volume, background 0. Same bits for any number of threads. Throws
/// InvalidOption for a voxel size that is not positive and finite or too small for 32-bit voxel
/// coordinates, Cancelled.
FloatGridPtr shell_depth_grid(const TetMesh& tets, double voxel_size,
                              Interrupter* interrupter = nullptr);

/// Writes grids and metadata as docs/file_format.md says; `file` is not changed. The file (with
/// PointPlacement::beside both files) appears whole or not at all. Same bytes for the same input:
/// where OpenVDB draws a random UUID stands a digest of the file. Throws InvalidOption when a grid
/// is missing, when stack and tets do not fit together as make_tets leaves them, and when a
/// distance is beyond what the half floats that are asked for can hold; WriteError.
void write_shell_vdb(const std::filesystem::path& path, const ShellFile& file,
                     const VdbWriteOptions& options = {}, OutputSet* with = nullptr);

/// Reads what write_shell_vdb wrote, bit for bit (half floats as they were rounded, the mark that
/// they were saved so kept); finds points that stand beside the file. Throws ReadError with file,
/// grid, attribute and index for anything that is missing, out of range, or not what the file's own
/// digests say. Files without digests are read (ShellFile::digests is 0). Nothing of the file is
/// decoded before require_whole_vdb has passed it.
ShellFile read_shell_vdb(const std::filesystem::path& path);

/// The metadata alone, without a grid. Throws ReadError as read_shell_vdb does.
ShellInfo read_shell_info(const std::filesystem::path& path);

/// NAME.points.vdb for NAME.vdb: where PointPlacement::beside puts the point grids.
std::filesystem::path points_file_of(const std::filesystem::path& path);

/// A float grid of a .vdb, for painted thickness: by name, or the only float grid when `name` is
/// empty. A grid saved with half floats is a float grid. Throws ReadError naming the grids that the
/// file has, with their types.
FloatGridPtr read_float_grid(const std::filesystem::path& path, const std::string& name);

} // namespace vdb_shell
