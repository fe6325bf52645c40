// SPDX-License-Identifier: Apache-2.0

// Takes an embedded surface and leaves an embedded one with fewer triangles, within a tolerance.
// After a bounded number of repeats (collapse_embedded.h) the input itself is the answer, which is
// valid though not smaller.

#include "resample/simplify.h"

#include "core/stage_progress.h"
#include "resample/collapse_embedded.h"
#include "vdb_shell/mesh/check_mesh.h"

#include <cmath>
#include <utility>

namespace vdb_shell
{
namespace
{

constexpr int kMaxRepeats = 12;

bool is_sound(const TriangleMesh& mesh)
{
    const MeshCheck check = check_mesh(mesh);
    return check.closed() && check.manifold() && check.embedded() &&
           check.inconsistent_edges.count == 0 && check.degenerate_triangles.count == 0 &&
           check.duplicate_triangles.count == 0;
}

} // namespace

Simplified simplify(const TriangleMesh& mesh, const SimplifyLimits& limits,
                    Interrupter* interrupter)
{
    const StageProgress progress(interrupter, "simplify");
    const double tolerance = limits.tolerance;
    if (!(tolerance > 0.0))
        return {mesh, 0};
    CollapseLimits collapse;
    collapse.fewest_triangles = limits.fewest_triangles;
    collapse.distance = tolerance;
    collapse.between_vertices = limits.between_vertices;
    collapse.longest_edge = limits.longest_edge;
    if (limits.bound_quadric)
        // A quadric error is a squared distance times an area. Its bound is the squared tolerance
        // over an area of the squared tolerance, which has the right unit and needs no further
        // number.
        collapse.quadric_error = std::pow(tolerance, 4);
    // Collapses go by the quadric error alone. With coarsen's weight of the length, the result on
    // the mesh fandisk was five times as far from the input.
    collapse.length_weight = 0;
    EmbeddedCollapse left = collapse_embedded(mesh, collapse, kMaxRepeats, progress);
    if (left.embedded && is_sound(left.result.mesh))
        return {std::move(left.result.mesh), left.repeats};
    return {mesh, left.repeats};
}

} // namespace vdb_shell
