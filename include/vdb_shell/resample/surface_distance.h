// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdb_shell/core/interrupter.h"
#include "vdb_shell/mesh/triangle_mesh.h"

#include <cstddef>

namespace vdb_shell
{

/// How far one surface is from another, world units.
struct DistanceFigures {
    double mean = 0;
    double max = 0;
    std::size_t samples = 0;
};

/// The smallest spacing that surface_distance takes for a surface, world units: of 2^27 points at
/// most. A surface of many copies of its triangles may have more area than memory has room for.
double finest_spacing(const TriangleMesh& from);

/// Distances of points of `from` to the nearest points of `to`: one-sided, so ask both ways. The
/// points are the centres of pieces that no edge longer than `spacing` bounds (triangles are
/// halved at their longest edge), each weighted with its area in the mean, and all corners, which
/// count for the maximum alone. Of a surface with more squares of the spacing than its box has
/// cubes of it, one point stands for all in a cube. Same result for any number of threads. Throws
/// InvalidOption for a spacing that is not positive or smaller than finest_spacing; GeometryError
/// for a surface without triangles.
DistanceFigures surface_distance(const TriangleMesh& from, const TriangleMesh& to, double spacing,
                                 Interrupter* interrupter = nullptr);

} // namespace vdb_shell
