// SPDX-License-Identifier: Apache-2.0
// Volumes inside a surface, carried to a pose of it: deform_fog FOG.vdb REST.vdb POSED.vdb OUT.vdb

#include <vdb_shell/io/volume_file.h>
#include <vdb_shell/volume/deform_volume.h>
#include <vdb_shell/write/vdb_file.h>

#include <openvdb/openvdb.h>

#include <exception>
#include <iostream>
#include <vector>

int main(int count, char** words)
try {
    if (count != 5) {
        std::cerr << "usage: deform_fog FOG.vdb REST.vdb POSED.vdb OUT.vdb\n";
        return 2;
    }
    openvdb::initialize();
    const auto rest = vdb_shell::read_shell_vdb(words[2]),
               posed = vdb_shell::read_shell_vdb(words[3]);
    vdb_shell::ShellMap from(rest.stack, rest.tets), to(posed.stack, posed.tets);
    make_linear_alike(from, to);
    std::vector<vdb_shell::GridBasePtr> carried;
    for (const auto& fog : vdb_shell::read_volumes(words[1])) {
        vdb_shell::DeformFigures figures;
        carried.push_back(vdb_shell::deform_volume(*fog, from, to, rest.placement.shift(),
                                                   vdb_shell::DeformOptions{}, figures));
        std::cout << figures.grid << ": mass " << figures.mass_before << " before, "
                  << figures.mass_after << " after\n";
    }
    vdb_shell::write_volumes(words[4], carried);
    return 0;
} catch (const std::exception& error) {
    std::cerr << "deform_fog: " << error.what() << '\n';
    return 1;
}
