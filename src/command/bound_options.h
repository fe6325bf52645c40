// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdb_shell/options/section.h"

#include "command/purpose.h"

#include <filesystem>
#include <string>
#include <vector>

namespace CLI
{
class App;
class Option;
} // namespace CLI

namespace vdb_shell::command
{

/// A described option of a command, and what was given for it.
struct BoundOption {
    Option option;
    OptionValue default_value;
    CLI::Option* given = nullptr;           ///< its flag; null where it has none
    CLI::Option* shorthand_given = nullptr; ///< Option::shorthand
};

/// The command's options; their structs have to outlive it.
struct BoundOptions {
    OptionSections sections;
    std::vector<BoundOption> options;
};

/// All words by which the option can be given, the negation of a flag and the shorthand with them.
/// Precondition: it has a flag.
std::vector<std::string> flags_of(const Option& option);
/// Those of all that have a flag, in their order.
std::vector<std::string> flags_of(const BoundOptions& bound);

/// Adds a flag for every option that has one, group by group, with help made of the descriptions.
/// The fields must still have their defaults; parsing does not change them, apply() does.
BoundOptions bind(CLI::App& app, OptionSections sections);

/// Sets the fields: first what the purpose says and what the file of options says, if there are
/// any, then what flags say; what comes later wins. Throws InvalidOption, with the name that the
/// user gave, for impossible values and for flags that exclude or need each other; ReadError for a
/// file that is none.
void apply(BoundOptions& bound);

/// The option that has apply() begin with the options for a purpose.
Option purpose_option(Purpose& purpose);
/// The option that gives apply() its file.
Option preset_option(std::filesystem::path& preset);

} // namespace vdb_shell::command
