// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdb_shell/houdini/geometry.h"

#include "fields.h"

namespace vdb_shell::houdini
{

/// The attributes of one class; those of kinds that have no place are named in `unread`.
std::vector<Attribute> read_attributes(const Value& list, std::size_t elements, const Where& where,
                                       const char* kind, Budget& budget,
                                       std::vector<std::string>& unread);

/// Fills vertex_point and primitives. Vertices are renumbered into the order of their primitives;
/// the result has for each its number in the file, or is empty when nothing changed.
std::vector<std::uint32_t> read_primitives(const Value& topology, const Value& primitives,
                                           std::size_t vertex_count, std::size_t primitive_count,
                                           const Where& where, HoudiniGeometry& geometry);

std::vector<Group> read_groups(const Value& list, std::size_t elements, const Where& where,
                               const char* kind, Budget& budget, std::vector<std::string>& unread);

} // namespace vdb_shell::houdini
