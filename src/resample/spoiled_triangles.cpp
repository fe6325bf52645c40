// SPDX-License-Identifier: Apache-2.0

// Takes a surface and marks the triangles that keep it from being embedded, exactly on its float32
// points: those without area, and those that touch another one. The test of contacts is not defined
// for triangles without area, which are therefore found first and left out. Pairs are tested by
// several threads and marked by one, so the answer does not depend on their number.

#include "resample/spoiled_triangles.h"

#include "core/triangle_pairs.h"
#include "mesh/surface_defects.h"
#include "mesh/triangle_contacts.h"

namespace vdb_shell
{

std::vector<char> spoiled_triangles(const TriangleMesh& mesh)
{
    std::vector<char> bad = find_degenerate(mesh.points, mesh.triangles);
    const TriangleContacts contacts(mesh.points, mesh.triangles);
    const auto touch = [&](std::uint32_t a, std::uint32_t b) {
        return !bad[a] && !bad[b] && contacts.touch(a, b);
    };
    for (const auto& [a, b] : overlapping_triangles(mesh.points, mesh.triangles, touch))
        bad[a] = bad[b] = 1;
    return bad;
}

} // namespace vdb_shell
