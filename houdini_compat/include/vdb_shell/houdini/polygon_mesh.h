// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdb_shell/houdini/geometry_file.h"
#include "vdb_shell/io/read_mesh.h"
#include "vdb_shell/io/texture_coordinates.h"

#include <filesystem>

namespace vdb_shell::houdini
{

/// A surface from a Houdini geometry file, as read_mesh reads the other formats: polygons turned
/// round (Houdini's run clockwise seen from outside), triangulated, welded on request, points in
/// the file's order. Throws ReadError as read_geometry and read_mesh do, and for tetrahedra.
ReadResult read_polygon_mesh(const std::filesystem::path& path, const ReadOptions& options = {});

/// The same for a geometry in memory; `name` opens the messages.
ReadResult polygon_mesh(const ReadGeometry& read, const std::string& name,
                        const ReadOptions& options = {});

/// Its texture coordinates: the vertex attribute `uv`, or else the point attribute, of two or three
/// floats, of which the third is not read. Throws ReadError as read_polygon_mesh does, and for a
/// geometry without one.
TextureCoordinates read_polygon_texture(const std::filesystem::path& path,
                                        const Placement& placement = {});

/// The same for a geometry in memory; `name` opens the messages.
TextureCoordinates polygon_texture(const ReadGeometry& read, const std::string& name,
                                   const Placement& placement = {});

} // namespace vdb_shell::houdini
