// SPDX-License-Identifier: Apache-2.0

// Makes the frames of a motion, to try `vdb_shell pose` with:
//
//   make_motion samples/meshes/creature.obj walk 100 FOLDER    FOLDER/walk.0001.obj and so on
//
// Motions are walk (of the creature), twist (half a turn), squash (to half its length) and bend (a
// quarter of a circle, both ends up). The triangles are those of the mesh in every frame.

#include "shapes/motions.h"

#include <vdb_shell/io/read_mesh.h>

#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <iostream>
#include <string>

namespace
{

std::vector<openvdb::Vec3s> points_at(const std::string& motion,
                                      const std::vector<openvdb::Vec3s>& rest, double phase)
{
    using namespace vdb_shell::samples;
    if (motion == "walk")
        return walk(rest, phase);
    if (motion == "twist")
        return twist(rest, 180, phase);
    if (motion == "squash")
        return squash(rest, 0.5, phase);
    if (motion == "bend")
        return bend(rest, 90, phase);
    throw std::invalid_argument("no motion \"" + motion +
                                "\": walk, twist, squash and bend are known");
}

} // namespace

int main(int argc, char** argv)
{
    if (argc != 5) {
        std::cerr << "usage: make_motion MESH walk|twist|squash|bend FRAMES FOLDER\n";
        return 2;
    }
    try {
        const std::string motion = argv[2];
        const int frames = std::stoi(argv[3]);
        const std::filesystem::path folder = argv[4];
        std::filesystem::create_directories(folder);
        const vdb_shell::TriangleMesh rest = vdb_shell::read_mesh(argv[1]).mesh;
        for (int frame = 1; frame <= frames; ++frame) {
            char number[16];
            std::snprintf(number, sizeof number, "%04d", frame);
            const double phase = frames > 1 ? double(frame - 1) / (frames - 1) : 1;
            vdb_shell::write_mesh(folder / (motion + "." + number + ".obj"),
                                  {points_at(motion, rest.points, phase), rest.triangles});
        }
    } catch (const std::exception& error) {
        std::cerr << "make_motion: " << error.what() << '\n';
        return 1;
    }
    return 0;
}
