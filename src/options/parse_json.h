// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json_fwd.hpp>

#include <string>

namespace vdb_shell
{

/// What may stand inside each other in JSON of others. Files of ours have less than ten.
inline constexpr int kDeepestJson = 100;

/// The JSON of a text that others wrote. Throws ReadError "`name`: `otherwise`: reason" for one
/// that is none, and where arrays and objects are nested deeper than kDeepestJson.
nlohmann::ordered_json parse_json(const std::string& text, const std::string& name,
                                  const std::string& otherwise = "is no JSON");

/// The same as what nlohmann calls a discarded value, where parse_json would throw.
nlohmann::json parse_json_if_any(const std::string& text);

} // namespace vdb_shell
