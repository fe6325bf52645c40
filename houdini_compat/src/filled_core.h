// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdb_shell/houdini/geometry.h"
#include "vdb_shell/write/vdb_file.h"

#include "added_elements.h"

#include <string>

namespace vdb_shell::houdini
{

/// Appends the core of the file to the geometry of its shell, with a value in each of its
/// attributes, and adds point group `core_points` and primitive group `core_tets`. Precondition:
/// require_consistent_core; `geometry` has neither digests nor a core.
void append_core(const ShellFile& file, const ShellPoints& points, HoudiniGeometry& geometry);

/// Fills file.core, and where the shell is posed rest and velocity of the core's points.
/// Precondition: the shell itself has been read. Throws ReadError for what is not in range.
void read_core(const HoudiniGeometry& geometry, const AddedSize& size, const std::string& name,
               ShellFile& file);

} // namespace vdb_shell::houdini
