// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdb_shell/core/grid_types.h"
#include "vdb_shell/mesh/triangle_mesh.h"

namespace vdb_shell
{

/// Whether a mesh, given in voxels, has so many sheets that each voxel within the band around its
/// box has several in it.
bool fills_voxels(const TriangleMesh& mesh, double band);

/// Distances without a sign to a mesh that is given in voxels, the exact ones rounded to float32,
/// in all voxels that are nearer than the band; the band elsewhere. Voxel by voxel, so that the
/// grid bounds the work, where OpenVDB's tool (mesh_distances.h) looks at all voxels of each
/// triangle. The same for any number of threads. Precondition: the mesh has a triangle.
FloatGridPtr unsigned_distances_by_voxels(const TriangleMesh& mesh, double band);

} // namespace vdb_shell
