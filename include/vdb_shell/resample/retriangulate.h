// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdb_shell/core/interrupter.h"
#include "vdb_shell/mesh/triangle_mesh.h"
#include "vdb_shell/options/describe.h"
#include "vdb_shell/resample/remesh.h"

#include <cstddef>
#include <optional>

namespace vdb_shell
{

struct RetriangulateOptions {
    bool wanted = false; ///< turn edges inside flat parts of the surface
    /// The farthest that either surface may be from the other, world units. Unset: 1e-5 of the
    /// bounding box's diagonal, a few digits more than coordinates are rounded by.
    std::optional<double> tolerance;
};
OptionList describe(RetriangulateOptions& options);

struct RetriangulateReport {
    std::size_t flat_triangles = 0; ///< those with a neighbour in their plane
    std::size_t flat_parts = 0;     ///< that these form
    std::size_t flips = 0;          ///< edges turned, again and again where that helped
    std::size_t kept_parts = 0;     ///< left as they were, for they would have touched others
    double tolerance = 0;           ///< world units
    double farthest = 0;            ///< no point of either surface is farther from the other
    TriangleFigures shape_before, shape;
};

struct RetriangulateResult {
    TriangleMesh mesh; ///< the input's points, in its order, and as many triangles
    RetriangulateReport report;
};

/// The same points and the same shape in better triangles: inside each flat part edges are flipped
/// until none of them makes the smallest angle of its two triangles larger, which is a Delaunay
/// triangulation of that part between the edges around it (Lawson 1977, "Software for C1 surface
/// interpolation"). A part is what lies between two planes that are no farther from each other than
/// the tolerance, and is seen from outside, exactly, along one axis; so surfaces before and after
/// are as near as that. Edges that bound a part stay, so no feature is lost. Where triangles would
/// touch others, which flat parts that are not exactly flat may, the part stays as it was: the
/// result is embedded, exactly, like the input. Same result for any number of threads.
/// Precondition: manifold, consistently oriented, embedded mesh. Throws InvalidOption when an
/// option is out of its range, and Cancelled.
RetriangulateResult retriangulate(const TriangleMesh& mesh, const RetriangulateOptions& options,
                                  Interrupter* interrupter = nullptr);

} // namespace vdb_shell
