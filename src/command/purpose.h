// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdb_shell/options/name_table.h"
#include "vdb_shell/pipeline.h"

#include <string>

namespace vdb_shell::command
{

/// What the shell is made for: a set of options by name.
enum class Purpose {
    any,         ///< the defaults
    simulation,  ///< well shaped tets in two tapered layers
    fewest_tets, ///< one tapered layer
    thickness,   ///< as much of the solid as prisms can fill
    speed,       ///< most of the solid, soon: large surfaces
};
const NameTable<Purpose>& names(Purpose);

/// The options as JSON: samples/presets/NAME.json, word for word. An empty object for Purpose::any.
std::string options_for(Purpose purpose);

/// Throws InvalidOption where options take away what the purpose stands for (docs/options.md).
/// Other options of the preset may be overruled.
void require_fit(Purpose purpose, const ShellOptions& options);

} // namespace vdb_shell::command
