// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace vdb_shell
{

/// Text of a file as a terminal may have it: control characters are replaced by question marks. All
/// other bytes stay, as names may be in any encoding.
std::string shown(std::string_view text);

/// The same, with the ends of its lines left in.
std::string shown_lines(std::string_view text);

/// What shown() makes, cut where a character ends, with "..." where something is missing. A value
/// of a file may have many megabytes.
std::string shown_in_part(std::string_view text, std::size_t most_bytes = 80);

} // namespace vdb_shell
