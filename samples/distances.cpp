// SPDX-License-Identifier: Apache-2.0
// Signed distances and nearest triangles in a shell: distances SHELL.vdb OUT.vdb

#include <vdb_shell/io/volume_file.h>
#include <vdb_shell/volume/tet_distance.h>
#include <vdb_shell/write/vdb_file.h>

#include <openvdb/openvdb.h>

#include <algorithm>
#include <exception>
#include <iostream>

int main(int count, char** words)
try {
    if (count != 3) {
        std::cerr << "usage: distances SHELL.vdb OUT.vdb\n";
        return 2;
    }
    openvdb::initialize();
    const vdb_shell::ShellFile shell = vdb_shell::read_shell_vdb(words[1]);
    vdb_shell::TetDistanceOptions options;
    options.voxel_size = shell.surface->voxelSize()[0];
    const auto found = vdb_shell::tet_distances(shell.stack, shell.tets, options);
    vdb_shell::write_volumes(words[2], {found.distance, found.nearest});
    float least = 0;
    for (auto value = found.distance->cbeginValueOn(); value; ++value)
        least = std::min(least, *value);
    std::cout << found.distance->activeVoxelCount() << " voxels, the deepest at " << least << '\n';
    return 0;
} catch (const std::exception& error) {
    std::cerr << "distances: " << error.what() << '\n';
    return 1;
}
