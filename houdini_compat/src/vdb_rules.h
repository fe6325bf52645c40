// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdb_shell/houdini/vdb_conventions.h"

#include <openvdb/openvdb.h>

#include <map>
#include <string>
#include <vector>

// The parts of check_vdb_conventions. Each appends what breaks its rules.

namespace vdb_shell
{

using VdbViolations = std::vector<VdbViolation>;

/// The type that each name has had so far, and where: an attribute of Houdini has one type for the
/// whole geometry, whatever grid it comes from.
struct TypesByName {
    struct Entry {
        std::string type, grid;
    };
    std::map<std::string, Entry> metadata, attributes;
};

/// Letters, digits and underscores, no digit first: the names that attributes and groups can have.
bool is_houdini_name(const std::string& name);

void check_file_metadata(const openvdb::MetaMap& metadata, VdbViolations& found);
void check_grid_metadata(const openvdb::GridBase& grid, TypesByName& types, VdbViolations& found);

/// Class, background, transform, vector type and half floats.
void check_values(const openvdb::GridBase& grid, VdbViolations& found);

void check_point_attributes(const openvdb::GridBase& grid, TypesByName& types,
                            VdbViolations& found);

} // namespace vdb_shell
