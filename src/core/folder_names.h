// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <system_error>
#include <vector>

namespace vdb_shell
{

/// What stands in a folder, in no order, without "." and "..". `error` says why if it cannot be
/// listed to its end. Unlike std::filesystem::directory_iterator with an error code, whose
/// increment ends the process where memory runs out (libstdc++ 12), this throws std::bad_alloc.
std::vector<std::string> names_in(const std::filesystem::path& folder, std::error_code& error);

} // namespace vdb_shell
