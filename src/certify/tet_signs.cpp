// SPDX-License-Identifier: Apache-2.0

// Takes: tets. Gives: which of them are inverted or flat. By exact signs, because a volume in
// doubles near nought has no certain sign. Signs are computed in parallel and listed in index
// order.

#include "vdb_shell/certify/tet_signs.h"

#include "core/exact.h"
#include "core/parallel.h"
#include "mesh/defect_list.h"

namespace vdb_shell
{
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
    for (std::uint32_t i = 0; i < sign.size(); ++i) {
        if (sign[i] < 0)
            add_to(signs.inverted, i);
        if (sign[i] == 0)
            add_to(signs.flat, i);
    }
    return signs;
}

} // namespace vdb_shell
