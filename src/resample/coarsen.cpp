// SPDX-License-Identifier: Apache-2.0

// Takes a closed surface and leaves one of fewer triangles, for which nothing bounds the distance.
// That is enough for growth, which takes such a surface only for a start: what it makes of the hint
// is tested exactly on the surface itself. A surface that crosses itself is a bad start, for no
// pillar near the crossing has any length. A vertex from which no direction sees all triangles is
// let be: it is pinned there, and the next finer surface takes a point between those beside it
// (docs/measurements/tried.md, "Coarse surfaces that hide a vertex"). Idea and sources:
// edge_collapse.cpp.

#include "vdb_shell/resample/coarsen.h"

#include "core/stage_progress.h"
#include "resample/collapse_embedded.h"

#include <utility>

namespace vdb_shell
{
namespace
{

// Each repeat costs as much as the first try.
constexpr int kMostRepeats = 3;
// Twice the usual share: most of the vertices go anyway, so their order matters little. It takes a
// fifth less time, and shells end as full (tuned half of the scans, .9891 instead of .9882 in the
// mean, for speed .9789 instead of .9793).
constexpr double kShareOfRound = 0.4;
// Over the wanted number of triangles: a surface of more is no level that saves anything.
constexpr double kMostOverWanted = 2;

} // namespace

Coarsened coarsen(const TriangleMesh& mesh, std::size_t triangles, Interrupter* interrupter)
{
    CollapseLimits limits;
    limits.fewest_triangles = triangles;
    limits.share_of_round = kShareOfRound;
    const StageProgress progress(interrupter, "coarsen");
    EmbeddedCollapse sound = collapse_embedded(mesh, limits, kMostRepeats, progress);
    // Two walls that are close together all over would stay as fine as they are.
    if (sound.repeats > 0 &&
        double(sound.result.mesh.triangles.size()) > kMostOverWanted * double(triangles))
        sound = collapse_embedded(mesh, limits, 0, progress);
    sound.result.embedded = sound.embedded;
    return std::move(sound.result);
}

} // namespace vdb_shell
