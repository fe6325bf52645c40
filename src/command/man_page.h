// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "command/options_command.h"

#include <string>
#include <vector>

namespace vdb_shell::command
{

/// The page for `man`, made of the same descriptions as the help.
std::string man_page(const std::vector<CommandEntry>& commands);

} // namespace vdb_shell::command
