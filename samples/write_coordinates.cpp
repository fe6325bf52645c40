// SPDX-License-Identifier: Apache-2.0
// A shell's coordinates as grids: write_coordinates SHELL.vdb OUT.vdb

#include <vdb_shell/io/volume_file.h>
#include <vdb_shell/volume/coordinate_grids.h>
#include <vdb_shell/write/vdb_file.h>

#include <openvdb/openvdb.h>

#include <exception>
#include <iostream>

int main(int count, char** words)
try {
    if (count != 3) {
        std::cerr << "usage: write_coordinates SHELL.vdb OUT.vdb\n";
        return 2;
    }
    openvdb::initialize();
    const vdb_shell::ShellFile shell = vdb_shell::read_shell_vdb(words[1]);
    const vdb_shell::ShellMap map(shell.stack, shell.tets);
    vdb_shell::CoordinateInputs inputs;
    inputs.map = &map;
    inputs.stack = &shell.stack;
    vdb_shell::CoordinateOptions options;
    options.volumes = "rest,depth,thickness";
    options.voxel_size = shell.surface->voxelSize()[0];
    const auto grids = vdb_shell::coordinate_grids(inputs, options);
    vdb_shell::write_volumes(words[2], grids);
    for (const auto& grid : grids)
        std::cout << grid->getName() << ": " << grid->activeVoxelCount() << " voxels\n";
    return 0;
} catch (const std::exception& error) {
    std::cerr << "write_coordinates: " << error.what() << '\n';
    return 1;
}
