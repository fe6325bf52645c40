// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/option_names.h"

#include <CLI/CLI.hpp>

#include <map>
#include <string>

namespace vdb_shell::command
{

/// Binds an option to an enum field; the field's own value is the default that the help shows.
template <typename Enum>
CLI::Option* bind_enum(CLI::App& app, const std::string& flag, Enum& field, const std::string& help)
{
    std::map<std::string, Enum> by_name;
    std::string choices;
    for (const auto& [name, value] : names(field)) {
        by_name.emplace(name, value);
        choices += (choices.empty() ? "" : ", ") + name;
    }
    return app
        .add_option_function<std::string>(
            flag, [&field, by_name](const std::string& name) { field = by_name.at(name); },
            help + " (" + choices + ")")
        ->check([by_name, choices](const std::string& name) {
            return by_name.count(name) ? std::string() : "\"" + name + "\" is none of " + choices;
        })
        ->default_str(name_in_table(field))
        ->type_name("NAME");
}

} // namespace vdb_shell::command
