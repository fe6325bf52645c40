// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdb_shell/core/interrupter.h"
#include "vdb_shell/shell/tessellate.h"

#include <cstdint>
#include <optional>

namespace vdb_shell
{

struct CoverageOptions {
    /// Random points inside the solid. 0: no estimate is made.
    std::uint64_t samples = 100000;
    std::uint64_t seed = 1;
};

/// A second opinion by Monte Carlo, independent of all signs: in how many tets does a point lie?
/// Points are drawn uniformly in the bounding box of surface and shell until `samples` of them lie
/// inside the solid; the point-in-solid and point-in-tet tests are exact, so a point on a common
/// face is in neither tet and never counted twice.
struct Coverage {
    std::uint64_t samples = 0;         ///< points inside the solid
    std::uint64_t in_none = 0;         ///< of those: inside no tet
    std::uint64_t in_one = 0;          ///< inside exactly one
    std::uint64_t in_several = 0;      ///< inside two or more: an overlap
    std::uint64_t outside_covered = 0; ///< further points drawn, outside the solid but inside a tet
    double covered_share = 0;          ///< volume covered once or more / solid volume
    double overlap_share = 0;          ///< volume covered twice or more / solid volume
    double standard_error = 0;         ///< of covered_share
};

/// Works on any tets, inverted ones included (a point is inside whatever the orientation).
/// Deterministic for a seed, for any number of threads. Throws GeometryError when the solid's
/// volume is not positive, Cancelled.
Coverage estimate_coverage(const TriangleMesh& surface, const TetMesh& tets,
                           const CoverageOptions& options, Interrupter* interrupter = nullptr);

} // namespace vdb_shell
