// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdb_shell/mesh/placement.h"
#include "vdb_shell/obstacles/core_feet.h"
#include "vdb_shell/shell/tessellate.h"
#include "vdb_shell/write/input_points.h"
#include "vdb_shell/write/shell_points.h"

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace vdb_shell
{
class OutputSet;

/// The files that write_tets writes for this name: one, or TetGen's .node, .ele and .face, in that
/// order.
std::vector<std::filesystem::path> tet_files_of(const std::filesystem::path& path);

/// Extensions that write_tets knows: ".vtu", ".node", ".ele", ".mesh", ".msh".
const std::vector<std::string>& tet_file_extensions();

/// What .vtu has of each point besides; each list may be empty.
struct PointExtras {
    PillarValues pillars;                       ///< pillar_values
    std::vector<CoreFoot> feet;                 ///< feet_of_tet_points
    std::vector<openvdb::Vec3s> rest, velocity; ///< vectors_of_tet_points
    InputPoints input{};                        ///< not of the points: data of the whole
};

/// Writes the tets, by extension: VTK unstructured grid (.vtu), TetGen (.node, .ele and .face:
/// either of the first two names writes all), Medit (.mesh), Gmsh 4.1 (.msh). Coordinates are the
/// float32 values exactly, whether a program reads them into floats or doubles; with a placement
/// that moves, doubles where the file of the surface has them. Data beside them, where the format
/// has a place (docs/file_format.md): per point source vertex and layer, per tet its prism and, in
/// .vtu alone, its mean ratio and, where `certified` is given, its flag (Overlaps::certified); per
/// point, where `extras` have them (.vtu only), what its pillar has, its foot on a core, its place
/// at rest and its velocity, in the coordinates and the unit of the points. Files appear whole or
/// not at all; same bytes for the same tets, in any locale. Throws InvalidOption for an unknown
/// extension, for flags that are not one a tet and for extras that are not one a point; WriteError.
void write_tets(const std::filesystem::path& path, const TetMesh& tets,
                const std::vector<std::uint8_t>& certified = {}, const Placement& placement = {},
                const PointExtras& extras = {}, OutputSet* with = nullptr);

} // namespace vdb_shell
