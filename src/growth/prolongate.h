// SPDX-License-Identifier: Apache-2.0
#pragma once

// The shell of a coarser surface prolonged to a finer one.

#include "growth/connectivity.h"
#include "vdb_shell/growth/schedule.h"
#include "vdb_shell/mesh/triangle_mesh.h"
#include "vdb_shell/step/directions.h"

#include <openvdb/Types.h>

#include <array>
#include <cstdint>
#include <vector>

namespace vdb_shell::growth
{

/// The way of each vertex to its inner point.
struct Pillars {
    Directions lines; ///< visibility is that of the lines that the vertices had before
    std::vector<double> length;
};

/// The pillars to given inner points. Vertices that have no pillar keep their line, for growth may
/// release them.
Pillars pillars_to(const TriangleMesh& mesh, const std::vector<openvdb::Vec3s>& inner,
                   Directions lines);

/// A point of a coarse surface.
struct CoarsePoint {
    std::uint32_t triangle;
    std::array<double, 3> weight; ///< barycentric coordinates
};

/// The point of the coarse surface nearest each vertex, within the schedule's tolerance.
std::vector<CoarsePoint> nearest_coarse_points(const TriangleMesh& mesh, const TriangleMesh& coarse,
                                               const MultilevelSchedule& schedule);

/// The pillars of a surface prolonged from the shell of a coarser one of about the same shape: each
/// vertex goes along the prism in which its nearest point on the coarse surface lies, and the inner
/// points are made fair as the schedule says, but for those at their cap. A pillar of poor
/// visibility goes along the vertex's line instead, as far.
Pillars prolonged_pillars(const TriangleMesh& coarse,
                          const std::vector<openvdb::Vec3d>& coarse_inner, const TriangleMesh& mesh,
                          const Connectivity& connectivity, const std::vector<double>& cap,
                          const std::vector<CoarsePoint>& nearest, const Directions& lines,
                          const MultilevelSchedule& schedule = {});

} // namespace vdb_shell::growth
