// SPDX-License-Identifier: Apache-2.0
// Points inside a surface, carried to a pose of it: carry_points REST.vdb POSED.vdb < POINTS >
// MOVED

#include <vdb_shell/volume/shell_sampler.h>
#include <vdb_shell/write/vdb_file.h>

#include <openvdb/openvdb.h>

#include <exception>
#include <iostream>

int main(int count, char** words)
try {
    if (count != 3) {
        std::cerr << "usage: carry_points REST.vdb POSED.vdb < POINTS > MOVED\n";
        return 2;
    }
    openvdb::initialize();
    const auto rest = vdb_shell::read_shell_vdb(words[1]),
               posed = vdb_shell::read_shell_vdb(words[2]);
    vdb_shell::ShellMap from(rest.stack, rest.tets), to(posed.stack, posed.tets);
    make_linear_alike(from, to);
    const vdb_shell::ShellSampler sampler(from);
    openvdb::Vec3d point;
    while (std::cin >> point[0] >> point[1] >> point[2]) {
        const vdb_shell::ShellPlace place = sampler.find(point);
        if (!place.found()) {
            std::cout << "outside\n";
            continue;
        }
        const openvdb::Vec3d moved = to.point_of(place);
        std::cout << moved[0] << ' ' << moved[1] << ' ' << moved[2] << '\n';
    }
    return 0;
} catch (const std::exception& error) {
    std::cerr << "carry_points: " << error.what() << '\n';
    return 1;
}
