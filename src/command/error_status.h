// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <exception>
#include <string>

namespace vdb_shell::command
{

/// Each kind of error has its own status (docs/command_line.md), so that a script can tell a wrong
/// option from a surface that has no shell.
int status_of(const std::exception& error);

/// A word for a status, that programs compare with: it does not change. Several statuses of a
/// signal are one word.
const char* code_of(int status);

/// What a person is told.
std::string message_of(const std::exception& error);

/// What a program is told besides. All but `code` are empty where the message does not have them.
struct ErrorFacts {
    std::string code; ///< "usage", "read", "geometry", "write", ...: a word for the status
    std::string file;
    std::string option;
    std::string element; ///< "line 12", "vertex 7"
    std::string value;   ///< that is not allowed
    std::string limit;   ///< "above 0"
};
ErrorFacts facts_of(const std::exception& error);

} // namespace vdb_shell::command
