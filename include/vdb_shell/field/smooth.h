// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdb_shell/core/interrupter.h"
#include "vdb_shell/mesh/triangle_mesh.h"

#include <openvdb/openvdb.h>

namespace vdb_shell
{

struct SmoothOptions {
    /// Steps of mean-curvature flow. 0: the field is left alone (the paper's choice in 3D).
    int iterations = 0;
};

/// How far the zero crossing moved: |phi| of the smoothed field at the mesh's vertices, world
/// units.
struct SmoothReport {
    double mean_drift = 0;
    double max_drift = 0;
};

/// Mean-curvature flow of the level set, in place, then reinitialised to a distance field with the
/// depth of the interior band kept (the paper, section 2, "regularize by a curvature flow", [8]).
/// Precondition: a level set with uniform voxels, as mesh_to_level_set gives it. Throws
/// InvalidOption for a negative number of iterations, GeometryError when the flow has eaten the
/// whole surface, Cancelled.
SmoothReport smooth_level_set(openvdb::FloatGrid& level_set, const TriangleMesh& mesh,
                              const SmoothOptions& options, Interrupter* interrupter = nullptr);

} // namespace vdb_shell
