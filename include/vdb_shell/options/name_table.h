// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cassert>
#include <string>
#include <utility>
#include <vector>

namespace vdb_shell
{

/// The names that an enum's values have on the command line and in JSON. An enum that is an option
/// has, beside it, a function `const NameTable<Enum>& names(Enum)` whose argument is not read.
template <typename Enum> using NameTable = std::vector<std::pair<std::string, Enum>>;

template <typename Enum> const std::string& name_in_table(Enum value)
{
    for (const auto& [name, entry] : names(value))
        if (entry == value)
            return name;
    assert(false && "every enumerator stands in its table");
    return names(value).front().first;
}

} // namespace vdb_shell
