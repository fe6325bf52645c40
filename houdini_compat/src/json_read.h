// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "value.h"

#include <string>

namespace vdb_shell::houdini
{

/// JSON text. Throws ReadError "name: ..." with line and column.
Value read_json_text(const std::string& name, const std::string& bytes);

/// Houdini's binary JSON, in either byte order. Throws ReadError "name: ..." with the byte at which
/// the document breaks its rules.
Value read_json_binary(const std::string& name, const std::string& bytes);

} // namespace vdb_shell::houdini
