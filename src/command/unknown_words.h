// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "command/options_command.h"

#include <string>
#include <vector>

// What to say of words that nothing takes, with what they may have meant.

namespace vdb_shell::command
{

/// Of a word that stands where the command should. `commands`: all, and what stands beside every
/// command under no name.
std::string told_no_command(const std::string& word, const std::vector<CommandEntry>& commands);

/// Of words that no option and no file of the command takes, in the order in which they were given:
/// the first option among them that does not exist, or else the first word. Precondition: there are
/// such words.
std::string told_unknown(const std::vector<std::string>& words, const std::string& command,
                         const std::vector<CommandEntry>& commands);

} // namespace vdb_shell::command
