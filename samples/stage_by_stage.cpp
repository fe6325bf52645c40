// SPDX-License-Identifier: Apache-2.0
// Every stage by its own call, in the order of the data: stage_by_stage MESH OUT.vtu

#include <vdb_shell/io/read_mesh.h>
#include <vdb_shell/pipeline.h>
#include <vdb_shell/write/tet_file.h>

#include <openvdb/openvdb.h> // for what a level set itself can tell

#include <exception>
#include <iostream>

using namespace vdb_shell;

static void run(const char* mesh_file, const char* tet_file)
{
    const TriangleMesh mesh = read_mesh(mesh_file).mesh;
    const MeshCheck check = check_mesh(mesh);
    require_usable(check, {}, mesh_file); // throws, saying what is wrong and where
    std::cout << "check: " << check.triangles << " triangles, volume " << check.volume << '\n';

    LevelSetOptions field;
    field.resolution = 128;
    const double voxel = resolve_voxel_size(mesh, field);
    const auto level_set = mesh_to_level_set(mesh, field);
    std::cout << "level set: " << level_set->activeVoxelCount() << " voxels of " << voxel << '\n';

    const SmoothReport smooth = smooth_level_set(*level_set, mesh, {/*iterations*/ 1});
    std::cout << "smooth: moved by at most " << smooth.max_drift / voxel << " voxels\n";

    const Directions directions = compute_directions(mesh, *level_set, {});
    LineLengths lines = line_step(mesh, *level_set, directions, {});
    std::cout << "lines: median " << spread_of(lines.length).median << '\n';
    apply_limits(lines, vertex_limits(mesh, directions, Limit::adaptive));
    std::cout << "limits: median " << spread_of(lines.length).median << '\n';

    const PrismShell shell = extrude(mesh, directions, lines);
    const TetMesh tets = make_tets(shell, split_prisms(shell, {}));
    std::cout << "tets: " << tets.tets.size() << ", fill " << tet_volume(tets) / check.volume
              << '\n';

    const Coverage coverage = estimate_coverage(mesh, tets, {});
    std::cout << "inverted: " << count_tet_signs(tets).inverted.count << '\n'
              << "conforming: " << (check_conformity(shell, tets).conforming() ? "yes" : "no")
              << '\n'
              << "overlap: " << coverage.overlap_share << " of the volume\n";
    write_tets(tet_file, tets);
}

int main(int argc, char** argv)
try {
    if (argc != 3) {
        std::cerr << "usage: stage_by_stage MESH OUT.vtu\n";
        return 2;
    }
    run(argv[1], argv[2]);
    return 0;
} catch (const std::exception& error) {
    std::cerr << "stage_by_stage: " << error.what() << '\n';
    return 1;
}
