// SPDX-License-Identifier: Apache-2.0

#include "command/unknown_words.h"

#include "options/near_names.h"
#include "options/shown_text.h"

#include <algorithm>

namespace vdb_shell::command
{
namespace
{

/// By which options can be given to the command, those of every command with them.
std::vector<std::string> all_flags(const std::string& command,
                                   const std::vector<CommandEntry>& commands)
{
    std::vector<std::string> all{"--help"};
    for (const CommandEntry& entry : commands) {
        if (entry.name != command && !entry.name.empty())
            continue;
        const std::vector<std::string> flags = flags_of(*entry.bound);
        all.insert(all.end(), flags.begin(), flags.end());
    }
    return all;
}

} // namespace

std::string told_no_command(const std::string& word, const std::vector<CommandEntry>& commands)
{
    if (word.rfind('-', 0) == 0)
        return shown_in_part(word) + " is no option of every command, and no command is given";
    std::vector<std::string> names;
    for (const CommandEntry& command : commands)
        if (!command.name.empty())
            names.push_back(command.name);
    return shown_in_part(word) + " is no command" + hint_of_near(word, names);
}

std::string told_unknown(const std::vector<std::string>& words, const std::string& command,
                         const std::vector<CommandEntry>& commands)
{
    const std::vector<std::string> flags = all_flags(command, commands);
    // A flag may have its value behind an =.
    const auto flag_in = [](const std::string& word) { return word.substr(0, word.find('=')); };
    const auto exists = [&](const std::string& word) {
        return std::find(flags.begin(), flags.end(), flag_in(word)) != flags.end();
    };
    // What follows an option that does not exist may be its value: so that option comes first.
    const auto misspelt = std::find_if(words.begin(), words.end(), [&](const std::string& word) {
        return word.size() > 1 && word.front() == '-' && !exists(word);
    });
    if (misspelt != words.end())
        return shown_in_part(flag_in(*misspelt)) + " is no option of " + command +
               hint_of_near(flag_in(*misspelt), flags);
    return shown_in_part(words.front()) + " is one word too many for " + command +
           (exists(words.front()) ? "; behind -- there are no options" : "");
}

} // namespace vdb_shell::command
