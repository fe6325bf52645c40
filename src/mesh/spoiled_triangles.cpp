// SPDX-License-Identifier: Apache-2.0
#include "mesh/spoiled_triangles.h"

#include "core/box_pairs.h"
#include "core/exact.h"
#include "core/parallel.h"

namespace vdb_shell
{

std::vector<char> spoiled_triangles(const TriangleMesh& mesh)
{
    std::vector<char> bad(mesh.triangles.size());
    for_each_index(bad.size(), [&](std::size_t t) {
        const openvdb::Vec3I& c = mesh.triangles[t];
        bad[t] = exact::collinear(mesh.points[c[0]], mesh.points[c[1]], mesh.points[c[2]]);
    });
    const auto pairs = overlapping_pairs(triangle_boxes(mesh.points, mesh.triangles));
    std::vector<char> touching(pairs.size());
    for_each_index(pairs.size(), [&](std::size_t i) {
        const auto [a, b] = pairs[i];
        touching[i] = !bad[a] && !bad[b] &&
                      exact::triangles_touch(mesh.points, mesh.triangles[a], mesh.triangles[b]);
    });
    for (std::size_t i = 0; i < pairs.size(); ++i)
        if (touching[i])
            bad[pairs[i][0]] = bad[pairs[i][1]] = 1;
    return bad;
}

} // namespace vdb_shell
