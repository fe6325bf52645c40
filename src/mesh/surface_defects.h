// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "mesh/defect_list.h"
#include "mesh/topology.h"
#include "vdb_shell/core/interrupter.h"
#include "vdb_shell/mesh/check_mesh.h"

#include <cstdint>
#include <string>
#include <vector>

namespace vdb_shell
{

/// The defects that check_mesh counts, all of them, ascending.
struct SurfaceDefects {
    std::vector<Edge> boundary_edges, non_manifold_edges, inconsistent_edges;
    std::vector<std::uint32_t> non_manifold_vertices, degenerate_triangles, duplicate_triangles;
    std::vector<TrianglePair> self_intersections;
    bool more_self_intersections = false; ///< a crowd has more than are listed
};

/// The pairs of triangles that meet beyond shared corners, ascending; those marked in `left_out`,
/// one for each triangle, are not looked at. The interrupter may be null; throws Cancelled.
std::vector<TrianglePair> find_self_intersections(const TriangleMesh& mesh,
                                                  const std::vector<char>& left_out,
                                                  Interrupter* interrupter = nullptr);

/// Per triangle, whether its corners lie on one line. Exact.
std::vector<char> find_degenerate(const std::vector<openvdb::Vec3s>& points,
                                  const std::vector<openvdb::Vec3I>& triangles);

/// The interrupter may be null; throws Cancelled.
SurfaceDefects find_defects(const TriangleMesh& mesh, const EdgeUses& sorted_uses,
                            Interrupter* interrupter = nullptr);

/// Throws InvalidOption unless the points are finite and the corners index them.
void require_well_formed(const TriangleMesh& mesh, const std::string& caller);

/// What check_mesh says, given the defects.
MeshCheck summarise(const TriangleMesh& mesh, const EdgeUses& sorted_uses,
                    const SurfaceDefects& defects);

} // namespace vdb_shell
