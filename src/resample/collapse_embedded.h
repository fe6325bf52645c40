// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/stage_progress.h"
#include "resample/edge_collapse.h"

namespace vdb_shell
{

struct EmbeddedCollapse {
    Coarsened result;
    int repeats = 0; ///< how often some vertices had to be held
    /// No two triangles of the result touch but in what they share, and no component has turned
    /// inside out.
    bool embedded = false;
};

/// collapse_edges, and again with the vertices around all triangles that touch held, and those of
/// components that have turned inside out, until there are none or `most_repeats` are made; the
/// last result is given back as it is. What touches in the input stays so.
/// Precondition: closed, manifold, consistently oriented. Same result for any number of threads.
EmbeddedCollapse collapse_embedded(const TriangleMesh& mesh, CollapseLimits limits,
                                   int most_repeats, const StageProgress& progress);

} // namespace vdb_shell
