// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdb_shell/options/section.h"

#include <nlohmann/json.hpp>

#include <string>

namespace vdb_shell
{

nlohmann::ordered_json value_json(const OptionValue& value);

/// All options that are stored, one object a section; null for a section that is off.
nlohmann::ordered_json to_json(const OptionSections& sections);

/// Sets what the object names and leaves the rest. Throws InvalidOption "`name`: line_step.rho is
/// 2, must be 0 or more and less than 1", or for a key that no section has.
void set_from_json(const nlohmann::ordered_json& json, OptionSections& sections,
                   const std::string& name);

/// The same, but what no section has is left aside.
void set_known_from_json(const nlohmann::ordered_json& json, OptionSections& sections,
                         const std::string& name);

/// The object in a text. Throws ReadError, with `name`, for one that is no JSON object.
nlohmann::ordered_json parse_options(const std::string& text, const std::string& name);

/// Everything that is known of the options, for programs: an array of objects.
/// Precondition: the options have their defaults.
nlohmann::ordered_json schema_json(const OptionSections& sections);

} // namespace vdb_shell
