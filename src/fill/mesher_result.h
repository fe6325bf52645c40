// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdb_shell/mesh/triangle_mesh.h"

#include "fill/mesher_files.h"

namespace vdb_shell::fill
{

/// The tets that lie inside the surface: of the pieces that hang together by faces which are no
/// triangles of it, those that are behind most of theirs. A mesher fills a cavity of the void as
/// well, and may fill what is between the surface and its convex hull. In a piece all tets are
/// oriented alike.
std::vector<openvdb::Vec4I> tets_inside(const MesherTets& made, const TriangleMesh& surface);

/// Where a mesher has cut triangles of the surface by one new point each, on an edge or inside, a
/// tet between triangle and point is added, so that the triangle is whole again. Its volume is
/// about nothing until the point is moved inward (rounded_points).
void close_cut_triangles(MesherTets& inside, const TriangleMesh& surface);

/// The points in float32, the first `fixed` of them as they are. Where tets are flat or
/// rounding has turned them over, points behind the first `fixed` are moved until none is, if that
/// can be done by moving single points. `moved` counts them.
std::vector<openvdb::Vec3s> rounded_points(const std::vector<openvdb::Vec3d>& points,
                                           std::size_t fixed,
                                           const std::vector<openvdb::Vec4I>& tets,
                                           std::size_t& moved);

} // namespace vdb_shell::fill
