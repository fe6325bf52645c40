// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdb_shell/core/error.h"
#include "vdb_shell/volume/shell_map.h"
#include "vdb_shell/volume/surface_coordinates.h"
#include "vdb_shell/write/vdb_file.h"

#include "command/file_plan.h"

#include <filesystem>
#include <memory>
#include <string>

namespace vdb_shell::command
{

/// A shell's file with the map of its coordinates.
struct MappedShell {
    std::filesystem::path path;
    ShellFile file;
    std::unique_ptr<ShellMap> map;
};

/// Reads a .vdb or Houdini geometry; `plan` gets to know the file that its points stand in.
MappedShell map_shell(const std::filesystem::path& path, FilePlan& plan);

/// Runs the body; what it throws about a grid begins with the grid, and gets the name of the file
/// that the grid is from.
template <typename Body>
auto with_file_of_grids(const std::filesystem::path& path, const Body& body)
{
    try {
        return body();
    } catch (const InvalidOption& error) {
        const std::string text = error.what();
        if (text.rfind("grid \"", 0) != 0)
            throw;
        throw InvalidOption(path.string() + ": " + text);
    }
}

/// The map of the shell at rest; null where the file's own is that.
std::unique_ptr<ShellMap> map_at_rest(const MappedShell& shell);

/// How fast the shell moves (velocity_map); null where the file does not know.
std::unique_ptr<ShellMap> map_of_velocities(const MappedShell& shell);

/// `wanted`, in the file's unit, or where that is 0 the voxels of the shell's level set. In the
/// mesh's unit. Throws InvalidOption where there is neither.
double voxel_size_of(const MappedShell& shell, double wanted);

/// Of the shell's triangles, which are those of the mesh at rest or lie near it. Throws what
/// readers of texture coordinates throw.
SurfaceCoordinates texture_of(const std::filesystem::path& mesh, const MappedShell& shell);

/// Throws GeometryError unless the tets of both are the same: place for place, they are one shell.
void require_same_tets(const MappedShell& first, const MappedShell& second);

} // namespace vdb_shell::command
