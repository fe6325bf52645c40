// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

namespace vdb_shell
{

/// How the stage at `path` finds the .vdb wherever both are moved together.
std::string relative_asset(const std::filesystem::path& path, const std::filesystem::path& volume);

} // namespace vdb_shell
