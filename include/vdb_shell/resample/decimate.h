// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdb_shell/core/interrupter.h"
#include "vdb_shell/mesh/triangle_mesh.h"
#include "vdb_shell/options/describe.h"
#include "vdb_shell/resample/surface_distance.h"

#include <cstddef>
#include <optional>

namespace vdb_shell
{

struct DecimateOptions {
    /// Collapse edges down to this many triangles, at least 4. Unset: none.
    std::optional<std::size_t> triangles;
    /// The farthest that either surface may be from the other, world units. Unset: no bound.
    std::optional<double> tolerance;
};
OptionList describe(DecimateOptions& options);

struct DecimateReport {
    std::size_t before = 0, wanted = 0, triangles = 0;
    DistanceFigures input_to_result, result_to_input;
    int repeats = 0; ///< how often collapses were done anew, for triangles touched or were too far

    bool reached() const { return triangles <= wanted; }
};

struct DecimateResult {
    TriangleMesh mesh; ///< its points are some of the input's, unchanged
    DecimateReport report;
};

/// Throws InvalidOption when an option is out of its range.
void require_sensible(const DecimateOptions& options);

/// Edge collapses in the order of their quadric error until `triangles` are left, or no collapse is
/// left that turns no normal by more than 40 degrees, makes no sliver and keeps within `tolerance`.
/// The distance is measured afterwards, both ways (surface_distance, at a quarter of the tolerance
/// or 1/256 of the diagonal, the larger of the two); where it exceeds the tolerance all is done
/// anew with a smaller one. The result is closed, manifold and embedded like the input; the last
/// resort is the input itself. Fewer triangles than can be had are no error: the report tells.
/// Precondition: `triangles` is set; closed, manifold, embedded mesh. Same result for any number of
/// threads. Throws InvalidOption, Cancelled.
DecimateResult decimate(const TriangleMesh& mesh, const DecimateOptions& options,
                        Interrupter* interrupter = nullptr);

} // namespace vdb_shell
