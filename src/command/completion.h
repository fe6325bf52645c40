// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "command/options_command.h"

#include <string>
#include <vector>

namespace vdb_shell::command
{

/// A script that makes bash complete commands, flags, choices and file names, for
/// `eval "$(vdb_shell options --complete bash)"`.
std::string bash_completion(const std::vector<CommandEntry>& commands);

} // namespace vdb_shell::command
