// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "mesh/surface_defects.h"
#include "vdb_shell/inspect/inspect_mesh.h"

#include <vector>

namespace vdb_shell
{

/// All that inspect_mesh counts, every element of it, ascending.
struct DefectMarks {
    EdgeUses uses;
    SurfaceDefects surface;
    std::vector<std::uint32_t> flipped, one_sided; ///< triangles; first triangles of pieces
    std::vector<std::uint32_t> blind;              ///< points
    std::vector<std::uint32_t> thin;               ///< triangles
};

/// What features are measured against; 0 where the mesh has no size and the options say none.
double voxel_size_to_inspect(const TriangleMesh& mesh, const InspectOptions& options);

/// The interrupter may be null; throws Cancelled.
DefectMarks mark_defects(const TriangleMesh& mesh, double voxel_size,
                         Interrupter* interrupter = nullptr);

/// See MeshInspection::thin_triangles.
/// `repeats` are left out: copies of a triangle cannot be thinner than it is.
std::vector<std::uint32_t> find_thin_triangles(const TriangleMesh& mesh,
                                               const std::vector<std::uint32_t>& repeats,
                                               double voxel_size);

FloatLimits float_limits(const TriangleMesh& mesh);

} // namespace vdb_shell
