// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "mesh/topology.h"
#include "vdb_shell/mesh/triangle_mesh.h"

#include <cstdint>
#include <vector>

namespace vdb_shell
{

/// The unit direction whose smallest dot product with the unit normals given is largest, to a few
/// roundings of a double; zero where there are none. Where that product is not positive, one that
/// does not see all of them either.
openvdb::Vec3d most_visible(const std::vector<openvdb::Vec3d>& normals);

/// The smallest dot product of d and one of these; infinite where there are none.
double smallest_dot(const std::vector<openvdb::Vec3d>& normals, const openvdb::Vec3d& d);

/// The inward unit normals of the triangles around a vertex; those without area have none.
std::vector<openvdb::Vec3d> star_normals(const TriangleMesh& mesh,
                                         const VertexTriangles::Range& around);

/// Vertices from which no direction sees all their triangles, ascending: wherever their pillar
/// goes, some tet on it is flat or inverted. Exact; a triangle without area does not count.
std::vector<std::uint32_t> blind_vertices(const TriangleMesh& mesh);

} // namespace vdb_shell
