// SPDX-License-Identifier: Apache-2.0
// Tiles of a volume in a shell, by texture coordinates: map_texture TILE.vdb SHELL.vdb MESH.obj
// OUT.vdb

#include <vdb_shell/io/texture_coordinates.h>
#include <vdb_shell/io/volume_file.h>
#include <vdb_shell/volume/map_volume.h>
#include <vdb_shell/volume/surface_coordinates.h>
#include <vdb_shell/write/vdb_file.h>

#include <openvdb/openvdb.h>

#include <exception>
#include <iostream>
#include <vector>

int main(int count, char** words)
try {
    if (count != 5) {
        std::cerr << "usage: map_texture TILE.vdb SHELL.vdb MESH.obj OUT.vdb\n";
        return 2;
    }
    openvdb::initialize();
    const vdb_shell::ShellFile shell = vdb_shell::read_shell_vdb(words[2]);
    const auto textured = vdb_shell::read_texture_coordinates(words[3], shell.placement);
    const auto texture = vdb_shell::surface_coordinates(
        textured, {shell.stack.surface(shell.stack.skin), shell.stack.triangles()});
    const vdb_shell::ShellMap map(shell.stack, shell.tets);
    vdb_shell::MapOptions options;
    options.repeat_u = options.repeat_v = 8;
    options.voxel_size = shell.surface->voxelSize()[0];
    std::vector<vdb_shell::GridBasePtr> mapped;
    for (const auto& tile : vdb_shell::read_volumes(words[1])) {
        vdb_shell::MapFigures figures;
        mapped.push_back(vdb_shell::map_volume(*tile, map, texture.corner, options, figures));
        std::cout << figures.grid << ": " << figures.active << " voxels, stretch "
                  << figures.stretch << '\n';
    }
    vdb_shell::write_volumes(words[4], mapped);
    return 0;
} catch (const std::exception& error) {
    std::cerr << "map_texture: " << error.what() << '\n';
    return 1;
}
