// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdb_shell/houdini/geometry.h"
#include "vdb_shell/write/vdb_file.h"

#include <filesystem>

namespace vdb_shell::houdini
{

/// The shell as docs/houdini.md lays it out: all pillar ends as points, the tets, then the outer
/// triangles, then the inner ones, one of each per prism. Grids are not part of it. Throws
/// InvalidOption when shell, split and tets do not fit together as make_tets leaves them.
HoudiniGeometry shell_geometry(const ShellFile& file);

/// The inverse, bit for bit; the grids of the result are null. Throws ReadError, its message opened
/// by `name`, for a geometry that is no shell, and for one whose parts contradict each other or the
/// checksum.
ShellFile shell_of_geometry(const HoudiniGeometry& geometry, const std::string& name);

/// True when the geometry says of itself that it is a shell.
bool is_shell(const HoudiniGeometry& geometry);

/// shell_geometry and write_geometry.
void write_shell_geometry(const std::filesystem::path& path, const ShellFile& file);

/// read_geometry and shell_of_geometry.
ShellFile read_shell_geometry(const std::filesystem::path& path);

} // namespace vdb_shell::houdini
