// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace vdb_shell::command
{

/// What to say of words that no option and no file of the command takes, in the order in which they
/// were given: the first option among them that does not exist, with those near to it, or else the
/// first word. `flags` are all that the command has. Precondition: there are such words.
std::string told_unknown(const std::vector<std::string>& words, const std::string& command,
                         const std::vector<std::string>& flags);

} // namespace vdb_shell::command
