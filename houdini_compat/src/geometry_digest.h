// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdb_shell/houdini/geometry.h"

#include <cstddef>
#include <string>

namespace vdb_shell::houdini
{

/// A line for the primitives, for each attribute and each group: its class, its name, the digest of
/// what it holds. The detail attribute that the lines are kept in is left out.
std::string digests_of(const HoudiniGeometry& geometry);

/// Adds those lines as a detail attribute, and their number as another. Nothing may be changed
/// afterwards.
void add_digests(HoudiniGeometry& geometry);

/// Holds a geometry against the lines that it carries, and says how many there are; 0 where it has
/// neither lines nor their number. Attributes and groups that somebody has added do not matter.
/// Throws ReadError, its message opened by `name`, with what has changed or is missing.
std::size_t require_digests(const HoudiniGeometry& geometry, const std::string& name);

} // namespace vdb_shell::houdini
