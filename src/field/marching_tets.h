// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/grid_instances.h"

#include <vector>

namespace vdb_shell
{

/// A surface in index space, in doubles.
struct IndexSurface {
    std::vector<openvdb::Vec3d> points;
    std::vector<openvdb::Vec3I> triangles;
};

/// The zero surface of the field on the Kuhn tetrahedra of its grid (six a cube, all around the
/// diagonal from its lowest corner to its highest, so that neighbours agree on every face). A tet
/// holds nothing, one triangle or two that share a diagonal, and their borders are segments of its
/// faces, one a face: each segment has exactly two triangles, those around a point form one ring
/// around the grid edge that the point lies on, and different tets share no inner points. So the
/// surface is manifold and embedded, and closed where all around every change of sign is known.
/// Points keep kClearance of an edge away from its ends, and thus apart from each other.
IndexSurface marching_tets(const openvdb::FloatGrid& field);

} // namespace vdb_shell
