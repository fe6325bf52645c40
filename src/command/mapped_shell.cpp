// SPDX-License-Identifier: Apache-2.0

#include "command/mapped_shell.h"

#include "vdb_shell/core/error.h"
#include "vdb_shell/houdini/geometry_file.h"
#include "vdb_shell/shell/core_tets.h"

#include "command/file_commands.h"

#include <utility>

namespace vdb_shell::command
{

MappedShell map_shell(const std::filesystem::path& path, FilePlan& plan)
{
    // The file says itself where its points are, if they are not in it.
    if (!houdini::has_geometry_extension(path))
        plan.add_input(read_shell_info(path).points_at);
    MappedShell shell{path, read_shell(path), {}, {}};
    const ShellFile& file = shell.file;
    TetMesh tets = joined_tets(file.tets, file.core);
    if (file.rest.posed()) {
        // The posed tets with other points: made anew they might share points at rest.
        TetMesh at_rest = tets;
        at_rest.points = vectors_of_tet_points(tets, rest_points(file));
        shell.rest = std::make_unique<ShellMap>(rest_stack(file), std::move(at_rest));
    }
    shell.map = std::make_unique<ShellMap>(file.stack, std::move(tets));
    return shell;
}

void require_same_tets(const MappedShell& first, const MappedShell& second)
{
    const TetMesh &a = first.map->tets(), &b = second.map->tets();
    if (a.tets != b.tets || a.prism != b.prism || a.prism_layer != b.prism_layer ||
        a.points.size() != b.points.size())
        throw InvalidOption(second.path.string() + ": its tets (" + std::to_string(b.tets.size()) +
                            ") are not those of " + first.path.string() + " (" +
                            std::to_string(a.tets.size()) +
                            "): the two are not one shell in two poses");
}

} // namespace vdb_shell::command
