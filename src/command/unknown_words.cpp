// SPDX-License-Identifier: Apache-2.0

#include "command/unknown_words.h"

#include "options/near_names.h"
#include "options/shown_text.h"

#include <algorithm>

namespace vdb_shell::command
{

std::string told_unknown(const std::vector<std::string>& words, const std::string& command,
                         const std::vector<std::string>& flags)
{
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
