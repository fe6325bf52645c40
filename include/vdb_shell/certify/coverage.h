// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdb_shell/core/interrupter.h"
#include "vdb_shell/options/describe.h"
#include "vdb_shell/shell/tessellate.h"

#include <cstdint>
#include <optional>

namespace vdb_shell
{

struct CoverageOptions {
    /// Random points inside the solid. 0: no estimate is made.
    std::uint64_t samples = 20000;
    std::uint64_t seed = 1;
};
OptionList describe(CoverageOptions& options);

/// A second opinion by Monte Carlo, independent of all signs: in how many tets does a point lie?
///
/// Points are uniform over every cell of a fixed grid that the solid or a tet may meet (the rest of
/// the bounding box would only be thrown away), rounded to float32, and drawn until `samples` of
/// them lie inside the solid. Solid: where the surface's winding number is not zero, by exact
/// crossings of a vertical ray; a point on the surface is not inside. The point-in-tet tests are
/// exact too, so a point on a common face is in neither tet and never counted twice.
struct Coverage {
    /// Points inside the solid. Fewer than asked for only when the solid is so thin that 1000
    /// times as many draws did not find enough.
    std::uint64_t samples = 0;
    std::uint64_t in_none = 0;    ///< of those: inside no tet
    std::uint64_t in_one = 0;     ///< inside exactly one
    std::uint64_t in_several = 0; ///< inside two or more: an overlap
    /// Points outside the solid but inside a tet, drawn on the way at the same density: their
    /// expected number is samples * (volume of the shell outside the solid / solid volume).
    std::uint64_t outside_covered = 0;
    double covered_share = 0;          ///< volume covered once or more / solid volume
    double overlap_share = 0;          ///< volume covered twice or more / solid volume
    double outside_share = 0;          ///< volume covered outside the solid / solid volume
    double standard_error = 0;         ///< of covered_share, binomial
    double overlap_standard_error = 0; ///< of overlap_share, binomial
};

/// Works on any tets, inverted ones included (a point is inside whatever the orientation); flat
/// ones hold no point. Point k depends on the seed and on k only: the same result for any number
/// of threads. Precondition: the surface is closed, all coordinates finite.
/// Throws GeometryError when the surface's signed volume is not positive, or no point at all could
/// be found inside it; Cancelled.
Coverage estimate_coverage(const TriangleMesh& surface, const TetMesh& tets,
                           const CoverageOptions& options, Interrupter* interrupter = nullptr);

} // namespace vdb_shell
