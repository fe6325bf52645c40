// SPDX-License-Identifier: Apache-2.0

#include "command/mapped_shell.h"

#include "vdb_shell/core/error.h"
#include "vdb_shell/houdini/geometry_file.h"
#include "vdb_shell/houdini/polygon_mesh.h"
#include "vdb_shell/io/texture_coordinates.h"
#include "vdb_shell/shell/core_tets.h"
#include "vdb_shell/volume/motion_volume.h"

#include "command/file_commands.h"

#include <openvdb/openvdb.h>

#include <utility>

// Takes files of shells; gives the maps that volumes go through. A place is carried from one map to
// another by the number of its tet, so all maps of a call have to be of the same tets.
namespace vdb_shell::command
{

MappedShell map_shell(const std::filesystem::path& path, FilePlan& plan)
{
    add_points_file(plan, path);
    MappedShell shell{path, read_shell(path), {}};
    // With the tets of a filled core, for a volume may lie there as well.
    shell.map =
        std::make_unique<ShellMap>(shell.file.stack, joined_tets(shell.file.tets, shell.file.core));
    return shell;
}

/// Null says that the file's own shell is at rest; callers then take that.
std::unique_ptr<ShellMap> map_at_rest(const MappedShell& shell)
{
    if (!shell.file.rest.posed())
        return {};
    // The posed tets with other points: made anew they might share points at rest.
    TetMesh at_rest = shell.map->tets();
    at_rest.points = vectors_of_tet_points(at_rest, rest_points(shell.file));
    return std::make_unique<ShellMap>(rest_stack(shell.file), std::move(at_rest));
}

std::unique_ptr<ShellMap> map_of_velocities(const MappedShell& shell)
{
    const PointVectors& velocity = shell.file.rest.velocity;
    if (velocity.empty())
        return {};
    return std::make_unique<ShellMap>(
        velocity_map(shell.file.stack, shell.map->tets(), velocity.surface,
                     vectors_of_tet_points(shell.map->tets(), velocity)));
}

double voxel_size_of(const MappedShell& shell, double wanted)
{
    // A length on the command line is in the unit of the file, as the voxels of the level set are
    // not: those are the mesh's.
    if (wanted != 0)
        return wanted / shell.file.placement.unit;
    if (!shell.file.surface)
        throw InvalidOption(shell.path.string() +
                            ": it has no level set, whose voxels these would have; give "
                            "--voxel-size");
    return shell.file.surface->voxelSize()[0];
}

SurfaceCoordinates texture_of(const std::filesystem::path& mesh, const MappedShell& shell)
{
    const Placement& placement = shell.file.placement;
    const TextureCoordinates textured = houdini::has_geometry_extension(mesh)
                                            ? houdini::read_polygon_texture(mesh, placement)
                                            : read_texture_coordinates(mesh, placement);
    // The textured surface is that at rest. In the pose no triangle would lie on one of its own.
    return surface_coordinates(textured, skin_surface(rest_stack(shell.file)));
}

void require_same_tets(const MappedShell& first, const MappedShell& second)
{
    const TetMesh &a = first.map->tets(), &b = second.map->tets();
    // Corner for corner: a place found in one is looked up in the other by its number.
    if (a.tets != b.tets || a.prism != b.prism || a.prism_layer != b.prism_layer ||
        a.points.size() != b.points.size())
        throw GeometryError(second.path.string() + ": its tets (" + std::to_string(b.tets.size()) +
                            ") are not those of " + first.path.string() + " (" +
                            std::to_string(a.tets.size()) +
                            "): the two are not one shell in two poses");
}

} // namespace vdb_shell::command
