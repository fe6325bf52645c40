// SPDX-License-Identifier: Apache-2.0

// The command `options`: the descriptions of all options as a table for people, as JSON for
// programs (the node in Houdini, for instance), or as completion for a shell. Everything is made of
// the same descriptions that the parser uses, so it cannot fall behind. It runs before any value is
// set, as only the command that was given is applied; so the values of the fields are the defaults.

#include "command/options_command.h"

#include "command/completion.h"
#include "command/exit_code.h"
#include "command/man_page.h"
#include "options/option_json.h"

#include <CLI/CLI.hpp>

#include <ostream>

namespace vdb_shell::command
{
namespace
{

nlohmann::ordered_json schema_of(const std::vector<CommandEntry>& commands)
{
    nlohmann::ordered_json json;
    // Raised when keys of this document change their meaning, so that a program can refuse what it
    // does not know.
    json["schema"] = 1;
    json["version"] = VDB_SHELL_VERSION;
    for (const CommandEntry& command : commands) {
        const nlohmann::ordered_json options = schema_json(command.bound->sections);
        // What stands beside every command has no command's name, and a key of its own.
        if (command.name.empty())
            json["options"] = options;
        else
            json["commands"][command.name] = {{"help", command.help}, {"options", options}};
    }
    return json;
}

/// What may stand behind the flag. The words are those that a message for a wrong value uses,
/// without its opening.
std::string values_of(const Option& option)
{
    if (option.kind == OptionKind::flag)
        return "on, off";
    if (option.kind == OptionKind::text)
        return "text";
    std::string text = expectation(option);
    const std::string one_of = "one of ";
    return text.rfind(one_of, 0) == 0 ? text.substr(one_of.size()) : text;
}

std::string default_of(const Option& option)
{
    const OptionValue value = option.get();
    if (option.kind == OptionKind::flag)
        return std::get<bool>(value) ? "on" : "off";
    return text_of(value);
}

void print_row(const OptionSection& section, const Option& option, std::ostream& out)
{
    const auto code = [](const std::string& text) {
        return text.empty() ? text : "`" + text + "`";
    };
    out << "| " << code(option.flag) << " | " << code(path_of(section, option)) << " | "
        << values_of(option) << " | "
        << (option.unit == Unit::none ? "" : name_in_table(option.unit)) << " | "
        << default_of(option) << " |\n";
}

void print_table(const OptionSections& sections, std::ostream& out)
{
    out << "| flag | key in a file | values | unit | default |\n|---|---|---|---|---|\n";
    for (const OptionSection& section : sections) {
        if (section.enable)
            print_row(section, *section.enable, out);
        for (const Option& option : section.options)
            // The table is of what can stand in a file; options without a key are files and
            // switches of the command line alone.
            if (!option.key.empty())
                print_row(section, option, out);
    }
}

} // namespace

const NameTable<Shell>& names(Shell)
{
    static const NameTable<Shell> table{{"bash", Shell::bash}};
    return table;
}

BoundOptions add_options_command(CLI::App& app, OptionsArguments& arguments)
{
    Option complete = option("", arguments.complete, "--complete",
                             "Print a script that makes a shell complete commands and flags");
    return bind(
        app,
        {{"", in_group("Options",
                       {option("", arguments.json, "--json",
                               "Print all that is known of the options of "
                               "every command, for programs"),
                        complete, option("", arguments.man, "--man", "Print the page for man")})}});
}

int run_options(const OptionsArguments& arguments, const std::vector<CommandEntry>& commands,
                std::ostream& out)
{
    if (arguments.json)
        out << schema_of(commands).dump(2) << '\n';
    else if (arguments.complete)
        out << bash_completion(commands);
    else if (arguments.man)
        out << man_page(commands);
    else
        for (const CommandEntry& command : commands)
            // `build` has all options that the other commands share with it.
            if (command.name == "build")
                print_table(command.bound->sections, out);
    return success;
}

} // namespace vdb_shell::command
