// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdb_shell/mesh/triangle_mesh.h"
#include "vdb_shell/options/describe.h"
#include "vdb_shell/step/directions.h"
#include "vdb_shell/step/line_step.h"

#include <vector>

namespace vdb_shell
{

/// Upper bounds on the extrusion length from the surface's local shape alone.
enum class Limit {
    none,
    uniform,  ///< the thin shell of [9]: one length for all, the smallest of all triangles' limits
    adaptive, ///< the adaptive thin shell [10]: per vertex, the smallest of its triangles' limits
};
const NameTable<Limit>& names(Limit);

struct LimitOptions {
    Limit limit = Limit::none;
};
OptionList describe(LimitOptions& options);

/// Per triangle, the smallest length at which the prism's Jacobian vanishes at one of its three
/// pillars when all three are extruded by the same length: the smallest positive root of n_i . A(e)
/// = 0, where A(e) = c + b e + a e^2 is the area vector of the offset triangle; infinity where
/// there is none.
std::vector<double> triangle_limits(const TriangleMesh& mesh, const Directions& directions);

/// Per vertex, under the chosen rule; all infinite for Limit::none.
std::vector<double> vertex_limits(const TriangleMesh& mesh, const Directions& directions,
                                  Limit limit);

/// Cuts lengths down to the limits; a vertex that is cut gets StopReason::limit.
/// Throws GeometryError when a length would stay infinite (Limit without stepping on an open
/// curvature and no thickness).
void apply_limits(LineLengths& lengths, const std::vector<double>& limits);

} // namespace vdb_shell
