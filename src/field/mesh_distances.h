// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdb_shell/core/grid_types.h"
#include "vdb_shell/core/interrupter.h"
#include "vdb_shell/mesh/triangle_mesh.h"

#include <openvdb/math/Transform.h>

namespace vdb_shell
{

/// OpenVDB's distances to triangles in a band of so many voxels, negative inside: everything within
/// the outermost surface counts as solid. Throws Cancelled.
FloatGridPtr signed_distances(const TriangleMesh& mesh, const openvdb::math::Transform& transform,
                              double exterior_voxels, double interior_voxels,
                              Interrupter* interrupter);

/// The same without a sign, of triangles that need not bound anything. Throws Cancelled.
FloatGridPtr unsigned_distances(const TriangleMesh& mesh, const openvdb::math::Transform& transform,
                                double band_voxels, Interrupter* interrupter);

} // namespace vdb_shell
