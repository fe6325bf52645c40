// SPDX-License-Identifier: Apache-2.0
// The shortest program: hello_shell MESH OUT.vtu

#include <vdb_shell/io/read_mesh.h>
#include <vdb_shell/pipeline.h>
#include <vdb_shell/write/tet_file.h>

#include <exception>
#include <iostream>

int main(int argc, char** argv)
{
    if (argc != 3) {
        std::cerr << "usage: hello_shell MESH OUT.vtu|.msh|.mesh|.node\n";
        return 2;
    }
    try {
        const vdb_shell::TriangleMesh mesh = vdb_shell::read_mesh(argv[1]).mesh;
        vdb_shell::ShellOptions options; // the defaults of the command
        options.level_set.resolution = 128;
        const vdb_shell::ShellResult result = vdb_shell::build_shell(mesh, options);
        vdb_shell::write_tets(argv[2], result.tets);
        std::cout << vdb_shell::report_text(result.report);
    } catch (const std::exception& error) {
        std::cerr << "hello_shell: " << error.what() << '\n';
        return 1;
    }
    return 0;
}
