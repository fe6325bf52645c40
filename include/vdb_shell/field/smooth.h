// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdb_shell/core/grid_types.h"
#include "vdb_shell/core/interrupter.h"
#include "vdb_shell/mesh/triangle_mesh.h"
#include "vdb_shell/options/describe.h"

namespace vdb_shell
{

struct SmoothOptions {
    /// Steps of mean-curvature flow. 0: the field is left alone (the paper's choice in 3D). A
    /// sphere of radius R has sqrt(R^2 - 2 n dx^2 / 3) after n steps with voxels of size dx.
    int iterations = 0;
};
OptionList describe(SmoothOptions& options);

/// How far the zero crossing moved: |phi| of the smoothed field at the mesh's vertices, world
/// units. No more than the width of the exterior band shows outside.
struct SmoothReport {
    double mean_drift = 0;
    double max_drift = 0;
};

/// Mean-curvature flow of the level set, in place, then reinitialised to a distance field with the
/// depth of the interior band kept (the paper, section 2, "regularize by a curvature flow", [8]).
/// The flow runs on the narrow band; the depth is measured anew from its zero crossing, so that
/// deep values are distances to the smoothed surface and not to the one before. Throws
/// InvalidOption for a negative number of iterations, GeometryError when the grid is no level set
/// with uniform voxels or the flow has eaten the whole surface, Cancelled (the level set is then of
/// no further use).
SmoothReport smooth_level_set(openvdb::FloatGrid& level_set, const TriangleMesh& mesh,
                              const SmoothOptions& options, Interrupter* interrupter = nullptr);

} // namespace vdb_shell
