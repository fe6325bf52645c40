// SPDX-License-Identifier: Apache-2.0

// Takes: tets. Gives: which of them are inverted or flat, by exact signs, and the sum of their
// volumes in doubles. The two are separate because a volume in doubles near nought has no certain
// sign. Signs are computed in parallel and listed in index order; the sum runs in index order in
// one thread, so that its last bit does not depend on the number of threads.

#include "vdb_shell/certify/tet_signs.h"

#include "core/exact.h"
#include "core/parallel.h"

namespace vdb_shell
{
namespace
{

void add_to(Defect<std::uint32_t>& defect, std::size_t tet)
{
    if (defect.first.size() < Defect<std::uint32_t>::kFirstShown)
        defect.first.push_back(static_cast<std::uint32_t>(tet));
    ++defect.count;
}

} // namespace

TetSigns count_tet_signs(const TetMesh& mesh)
{
    std::vector<int> sign(mesh.tets.size());
    for_each_index(sign.size(), [&](std::size_t i) {
        const openvdb::Vec4I& tet = mesh.tets[i];
        sign[i] = exact::orient3d(mesh.points[tet[0]], mesh.points[tet[1]], mesh.points[tet[2]],
                                  mesh.points[tet[3]]);
    });
    TetSigns signs;
    signs.tets = sign.size();
    for (std::size_t i = 0; i < sign.size(); ++i) {
        if (sign[i] < 0)
            add_to(signs.inverted, i);
        if (sign[i] == 0)
            add_to(signs.flat, i);
    }
    return signs;
}

double tet_volume(const TetMesh& mesh)
{
    double six_volumes = 0;
    for (const openvdb::Vec4I& tet : mesh.tets) {
        // Relative to the tet's own first corner: differences of near float32 points are exact in
        // doubles, so the volume is as accurate far from the origin.
        const openvdb::Vec3d a(mesh.points[tet[0]]);
        const openvdb::Vec3d ab = openvdb::Vec3d(mesh.points[tet[1]]) - a;
        const openvdb::Vec3d ac = openvdb::Vec3d(mesh.points[tet[2]]) - a;
        const openvdb::Vec3d ad = openvdb::Vec3d(mesh.points[tet[3]]) - a;
        six_volumes += ab.cross(ac).dot(ad);
    }
    return six_volumes / 6;
}

} // namespace vdb_shell
