// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

// Words as a shell reads and writes them. Pure functions.

namespace vdb_shell::command
{

/// The word as it can stand in a line for a POSIX shell: nothing in it has a meaning there.
std::string quoted(const std::string& word);

/// The words of a line: parted by blanks, with 'single' and "double" quotes and backslashes.
/// Nothing is expanded. Throws InvalidOption, beginning with `place`, for a quote that does not
/// end.
std::vector<std::string> split_words(const std::string& line, const std::string& place);

} // namespace vdb_shell::command
