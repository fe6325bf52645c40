// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdb_shell/houdini/geometry_file.h"
#include "vdb_shell/io/read_mesh.h"

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

} // namespace vdb_shell::houdini
