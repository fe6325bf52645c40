// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdb_shell/mesh/triangle_mesh.h"

#include <openvdb/Types.h>

#include <filesystem>
#include <optional>
#include <vector>

namespace vdb_shell::fill
{

/// What a mesher gave back. Points of the surface that it was given have the same indices here.
struct MesherTets {
    std::vector<openvdb::Vec3d> points;
    std::vector<openvdb::Vec4I> tets;
};

/// TetGen's .poly: a facet for each triangle. Throws WriteError.
void write_poly(const std::filesystem::path& path, const TriangleMesh& surface);
/// PATH.1.node and PATH.1.ele, as TetGen names them. Throws ProgramError for what is not there, not
/// whole, or out of range.
MesherTets read_tetgen(const std::filesystem::path& stem);

/// Gmsh's .msh (format 2.2) with the triangles of one discrete surface, and the .geo that reads it
/// from the same folder and has it filled. `edge_length`: the longest wanted; `optimise`: shapes
/// are made better afterwards. Throws WriteError.
void write_gmsh_input(const std::filesystem::path& geo, const std::filesystem::path& msh,
                      const TriangleMesh& surface, std::optional<double> edge_length,
                      bool optimise);
/// The tets of a .msh of format 2.2. Throws ProgramError as read_tetgen.
MesherTets read_gmsh_output(const std::filesystem::path& msh);

} // namespace vdb_shell::fill
