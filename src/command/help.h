// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace CLI
{
class App;
}

namespace vdb_shell::command
{

struct Example {
    std::string words; ///< behind the program's name
    std::string does;
};

/// What people mostly want of a command; of the program where the name is empty.
const std::vector<Example>& examples_of(const std::string& command);

/// The help of this command, and of those that are added to it later, begins with examples.
void begin_help_with_examples(CLI::App& app);

/// "vdb_shell 0.1.0" and, in lines of their own, libraries, compiler and kind of build.
std::string version_text();

} // namespace vdb_shell::command
