// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdb_shell/core/interrupter.h"
#include "vdb_shell/options/describe.h"
#include "vdb_shell/shell/prism_test.h"
#include "vdb_shell/shell/tessellate.h"

#include <cstddef>

namespace vdb_shell
{

struct ScaleOptions {
    double factor = 1.0; ///< share of each pillar's length that is kept, above 0 and at most 1
};
OptionList describe(ScaleOptions& options);

/// Throws InvalidOption for a factor that is not above 0 and at most 1.
void require_sensible(const ScaleOptions& options);

struct ScaleReport {
    std::size_t shortened = 0; ///< pillars that had to become shorter than the factor says
    std::size_t pinned = 0;    ///< of those: pillars that have no length left
};

/// Scales every pillar about its outer end: inner = outer + factor (inner - outer), rounded so that
/// no pillar is longer than factor times its length (as extrude). A factor of 1 changes no bit.
///
/// A shell with twelve positive tets in each prism stays free of overlaps under any factor
/// (docs/theory.md, "Layers, and shells scaled down"), rounding aside; one with the chosen three
/// need not. All prisms and triangles are tested exactly, and pillars around one that fails are
/// shortened further, at last pinned, until nothing fails: a certified shell stays certified. Same
/// bits for any number of threads. Precondition: a closed, manifold surface; a consistent split.
/// Throws InvalidOption for a factor that is not above 0 and at most 1, Cancelled.
ScaleReport scale_thickness(PrismShell& shell, const PrismSplit& split, const ScaleOptions& options,
                            PrismTest test, Interrupter* interrupter = nullptr);

} // namespace vdb_shell
