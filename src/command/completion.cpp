// SPDX-License-Identifier: Apache-2.0

// Makes a script for bash from the descriptions of all commands. The script is plain text that
// needs neither vdb_shell nor another program at the time of completion, so it answers at once and
// works if the program is not in the path. Names of commands, flags and choices are our own and
// contain no character that bash would read as something else; file names of the user go through a
// function that keeps blanks.

#include "command/completion.h"

#include "core/text_stream.h"

namespace vdb_shell::command
{
namespace
{

/// What to offer after each flag that takes a value: its choices, files, or nothing for numbers.
void write_values(std::ostream& out, const CommandEntry& command)
{
    for (const BoundOption& bound : command.bound->options) {
        const Option& option = bound.option;
        if (option.flag.empty() || option.kind == OptionKind::flag)
            continue;
        std::string pattern;
        // The pattern has the command in front, since the same flag may take other values in
        // another command. A shorthand takes no value.
        for (const std::string& flag : flags_of(option))
            if (flag != option.shorthand)
                pattern += (pattern.empty() ? "" : "|") +
                           (command.name.empty() ? "*" : command.name) + ":" + flag;
        out << "    " << pattern << ")\n        ";
        if (option.kind == OptionKind::choice) {
            out << "COMPREPLY=($(compgen -W '";
            for (const std::string& choice : option.choices)
                out << choice << ' ';
            out << "' -- \"$word\"))";
        } else if (option.kind == OptionKind::text) {
            out << "_vdb_shell_files \"$word\"";
        } else {
            // For numbers an empty list is better than file names, which bash would offer
            // otherwise.
            out << "COMPREPLY=()";
        }
        out << "\n        return ;;\n";
    }
}

void write_flags(std::ostream& out, const CommandEntry& command)
{
    for (const std::string& flag : flags_of(*command.bound))
        out << ' ' << flag;
}

/// What stands beside every command may be given behind it too.
void write_all_flags(std::ostream& out, const CommandEntry& command, const CommandEntry& global)
{
    out << "    " << (command.name.empty() ? "''" : command.name) << ") flags='--help";
    write_flags(out, command);
    if (command.name.empty())
        out << " --version";
    else
        write_flags(out, global);
    out << "' ;;\n";
}

std::string names_of(const std::vector<CommandEntry>& commands, const char* between)
{
    std::string names;
    for (const CommandEntry& command : commands)
        if (!command.name.empty())
            names += (names.empty() ? "" : between) + command.name;
    return names;
}

} // namespace

/// The word before the cursor decides first: behind a flag with a value only its values make sense.
/// Else a word that begins with a dash is completed to flags, the first plain word to a command and
/// all others to files.
std::string bash_completion(const std::vector<CommandEntry>& commands)
{
    OutText out;
    out << "# Completion of vdb_shell for bash, made by `vdb_shell options --complete bash`.\n"
           "_vdb_shell_files()\n"
           "{\n"
           "    local IFS=$'\\n'\n"
           "    COMPREPLY=($(compgen -f -- \"$1\"))\n"
           "}\n"
           "_vdb_shell()\n"
           "{\n"
           "    local word=${COMP_WORDS[COMP_CWORD]} before=${COMP_WORDS[COMP_CWORD-1]}\n"
           "    local command= flags= i\n"
           "    for ((i = 1; i < COMP_CWORD; ++i)); do\n"
           "        case ${COMP_WORDS[i]} in\n"
           "        "
        << names_of(commands, "|")
        << ")\n            command=${COMP_WORDS[i]}\n            break ;;\n"
           "        esac\n"
           "    done\n"
           "    case $command:$before in\n";
    for (const CommandEntry& command : commands)
        write_values(out, command);
    out << "    esac\n    case $command in\n";
    for (const CommandEntry& command : commands)
        write_all_flags(out, command, commands.front());
    out << "    esac\n"
           "    if [[ $word == -* ]]; then\n"
           "        COMPREPLY=($(compgen -W \"$flags\" -- \"$word\"))\n"
           "    elif [[ -z $command ]]; then\n"
           "        COMPREPLY=($(compgen -W '"
        << names_of(commands, " ")
        << "' -- \"$word\"))\n"
           "    else\n"
           "        _vdb_shell_files \"$word\"\n"
           "    fi\n"
           "}\n"
           "complete -o filenames -F _vdb_shell vdb_shell\n";
    return out.str();
}

} // namespace vdb_shell::command
