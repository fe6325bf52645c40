// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace vdb_shell
{

/// One thing in a .vdb that Houdini would drop, change or misread.
struct VdbViolation {
    std::string rule;    ///< its name in docs/vdb_conventions.md
    std::string grid;    ///< empty: the file
    std::string element; ///< a metadata key, attribute or group; empty: the grid as a whole
    std::string detail;  ///< what was found, and what the rule wants
};

/// All names that VdbViolation::rule can take.
const std::vector<std::string>& vdb_convention_rules();

/// Holds any .vdb, not only those of this program, against Houdini's published rules for names,
/// classes, vector types, metadata and point attributes. Sorted by the grids' names; empty when it
/// keeps them all. Reads every voxel, since some rules speak of values. Throws ReadError for a file
/// that OpenVDB cannot read, one with a grid of a type unknown to it included.
std::vector<VdbViolation> check_vdb_conventions(const std::filesystem::path& path);

/// One line without its end: "grid "v", attribute "uv": attribute-type: ...".
std::string to_text(const VdbViolation& violation);

} // namespace vdb_shell
