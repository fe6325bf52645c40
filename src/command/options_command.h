// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "command/bound_options.h"

#include <iosfwd>
#include <optional>
#include <string>
#include <vector>

namespace vdb_shell::command
{

enum class Shell { bash };
const NameTable<Shell>& names(Shell);

struct OptionsArguments {
    bool json = false;
    std::optional<Shell> complete; ///< print a script for it
    bool man = false;
};

/// One command as `options` shows it.
struct CommandEntry {
    std::string name; ///< empty: what stands before any command
    std::string help;
    const BoundOptions* bound = nullptr;
};

BoundOptions add_options_command(CLI::App& app, OptionsArguments& arguments);

/// Prints a table of build's options, all of them for programs, or a script for a shell, or a page
/// for man.
int run_options(const OptionsArguments& arguments, const std::vector<CommandEntry>& commands,
                std::ostream& out);

} // namespace vdb_shell::command
