// SPDX-License-Identifier: Apache-2.0
// Makes the sample meshes: vdb_shell_make_meshes OUTDIR

#include "shapes/bones.h"
#include "shapes/creature.h"
#include "shapes/simple_shapes.h"

#include <openvdb/openvdb.h>

#include <exception>
#include <filesystem>
#include <iostream>
#include <string>

int main(int argc, char** argv)
{
    namespace samples = vdb_shell::samples;
    if (argc != 2) {
        std::cerr << "usage: vdb_shell_make_meshes OUTDIR\n";
        return 2;
    }
    try {
        openvdb::initialize();
        const std::filesystem::path folder = argv[1];
        std::filesystem::create_directories(folder);
        const auto write = [&](const std::string& name, const samples::PolygonMesh& mesh) {
            samples::write_obj(folder / (name + ".obj"), mesh);
            std::cout << name << ".obj: " << mesh.points.size() << " vertices, "
                      << mesh.faces.size() << " faces\n";
        };
        write("sphere", samples::sphere(32, 16));
        write("box", samples::box(8));
        write("torus", samples::torus(48, 24));
        write("bracket", samples::bracket(32, 8));
        write("creature", samples::join_into_quads(samples::creature()));
        write("creature_bones", samples::creature_bones());
    } catch (const std::exception& error) {
        std::cerr << "vdb_shell_make_meshes: " << error.what() << '\n';
        return 1;
    }
    return 0;
}
