// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdb_shell/houdini/geometry.h"

#include <cstddef>
#include <string>

namespace vdb_shell::houdini
{

// Each adds to the detail attributes; counts are cut off at the largest int32.
void add_text(HoudiniGeometry& geometry, const char* name, const std::string& text);
void add_count(HoudiniGeometry& geometry, const char* name, std::size_t count);

/// Some figures of the report under names of their own, where it has them: Houdini's expressions
/// can use an attribute, but not a number inside of JSON. A report without them, or one that is no
/// JSON, just gives fewer attributes.
void add_figures(HoudiniGeometry& geometry, const std::string& report_json);

} // namespace vdb_shell::houdini
