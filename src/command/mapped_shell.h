// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdb_shell/volume/shell_map.h"
#include "vdb_shell/write/vdb_file.h"

#include "command/file_plan.h"

#include <filesystem>
#include <memory>

namespace vdb_shell::command
{

/// A shell's file with the map of its coordinates, and where it is posed that of the shell at rest.
struct MappedShell {
    std::filesystem::path path;
    ShellFile file;
    std::unique_ptr<ShellMap> map;
    std::unique_ptr<ShellMap> rest; ///< null where the shell is at rest

    const ShellMap& at_rest() const { return rest ? *rest : *map; }
};

/// Reads a .vdb or Houdini geometry; `plan` gets to know the file that its points stand in.
MappedShell map_shell(const std::filesystem::path& path, FilePlan& plan);

/// Throws InvalidOption unless the tets of both are the same: place for place, they are one shell.
void require_same_tets(const MappedShell& first, const MappedShell& second);

} // namespace vdb_shell::command
