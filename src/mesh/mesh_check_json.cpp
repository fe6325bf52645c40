// SPDX-License-Identifier: Apache-2.0

// The check of a surface as JSON, the same in the report of a shell and in that of a repair.
// Programs read the reports by these keys, so a key must not be renamed.

#include "mesh/mesh_check_json.h"

namespace vdb_shell
{

nlohmann::ordered_json mesh_check_json(const MeshCheck& check)
{
    nlohmann::ordered_json json{
        {"points", check.points},
        {"triangles", check.triangles},
        {"volume", check.volume},
        // The answers as well as the counts that they follow from, so that a script need not
        // know which defects make a surface open or not manifold.
        {"closed", check.closed()},
        {"manifold", check.manifold()},
        {"boundary_edges", check.boundary_edges.count},
        {"non_manifold_edges", check.non_manifold_edges.count},
        {"non_manifold_vertices", check.non_manifold_vertices.count},
        {"inconsistent_edges", check.inconsistent_edges.count},
        {"degenerate_triangles", check.degenerate_triangles.count},
        {"duplicate_triangles", check.duplicate_triangles.count},
        {"self_intersections", check.self_intersections.count},
        {"first_self_intersections", check.self_intersections.first}};
    // Only where it holds, for it hardly ever does.
    if (check.self_intersections.at_least)
        json["self_intersections_at_least"] = true;
    return json;
}

} // namespace vdb_shell
