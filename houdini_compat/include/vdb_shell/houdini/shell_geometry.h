// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdb_shell/houdini/geometry.h"
#include "vdb_shell/write/vdb_file.h"

#include <filesystem>

namespace vdb_shell
{
class OutputSet;
}

namespace vdb_shell::houdini
{

/// The shell as docs/houdini.md lays it out: the points of all surfaces, the tets of all layers,
/// then the triangles of the outermost surface, of the skin where it lies between, of the innermost
/// one. Grids are not part of it. Throws InvalidOption when stack and tets do not fit together as
/// make_tets leaves them, and for a shell of several layers that has vertices without triangles in
/// such numbers that it could not be read back within bounds.
HoudiniGeometry shell_geometry(const ShellFile& file);

/// The inverse, bit for bit; the grids of the result are null, all ripples stand in the first
/// split. Throws ReadError, its message opened by `name`, for a geometry that is no shell, and for
/// one whose parts contradict each other or the checksum.
ShellFile shell_of_geometry(const HoudiniGeometry& geometry, const std::string& name);

/// True when the geometry says of itself that it is a shell.
bool is_shell(const HoudiniGeometry& geometry);

/// shell_geometry and write_geometry.
void write_shell_geometry(const std::filesystem::path& path, const ShellFile& file,
                          OutputSet* with = nullptr);

/// read_geometry and shell_of_geometry.
ShellFile read_shell_geometry(const std::filesystem::path& path);

} // namespace vdb_shell::houdini
