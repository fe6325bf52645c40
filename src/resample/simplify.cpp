// SPDX-License-Identifier: Apache-2.0

// Takes an embedded surface and leaves an embedded one with fewer triangles, within a tolerance.
// Edge collapses know nothing of triangles that are not neighbours, so exact tests look for
// contacts afterwards. The vertices around these are fixed, and the collapses begin anew from the
// input; undoing single collapses would need their history. Fixed vertices only become more, and
// after a bounded number of repeats the input itself is the answer, which is valid though not
// smaller.

#include "resample/simplify.h"

#include "core/box_pairs.h"
#include "core/parallel.h"
#include "core/stage_progress.h"
#include "resample/edge_collapse.h"
#include "resample/spoiled_triangles.h"
#include "vdb_shell/mesh/check_mesh.h"

#include <algorithm>
#include <cmath>

namespace vdb_shell
{
namespace
{

using openvdb::Vec3s;

constexpr int kMaxRepeats = 12;
// By which share of its size, each time, the box around triangles that touch is widened.
constexpr double kMarginOfSize = 0.25;

/// Boxes around all triangles that spoil the surface; empty when it is sound.
std::vector<FloatBox> spoiled_places(const TriangleMesh& mesh)
{
    const std::vector<FloatBox> boxes = triangle_boxes(mesh.points, mesh.triangles);
    const std::vector<char> bad = spoiled_triangles(mesh);
    std::vector<FloatBox> places;
    for (std::size_t t = 0; t < bad.size(); ++t)
        if (bad[t])
            places.push_back(boxes[t]);
    return places;
}

/// Fixes the vertices in the boxes. The boxes are widened by a quarter of their own size for each
/// repeat so far, so that the next one fixes more than the last, but each time by no more than two
/// tolerances, which is how far the two sides of a contact can have moved towards each other.
void fix_vertices_in(std::vector<FloatBox> places, int repeat, double tolerance,
                     const TriangleMesh& mesh, std::vector<char>& fixed)
{
    for (FloatBox& box : places) {
        const FourFloats size = box.hi - box.lo;
        const float most = std::max({size[0], size[1], size[2]});
        const auto margin =
            static_cast<float>(repeat * std::min(2.0 * tolerance, kMarginOfSize * double(most)));
        box.lo -= four(margin);
        box.hi += four(margin);
    }
    for_each_index(mesh.points.size(), [&](std::size_t v) {
        const Vec3s& p = mesh.points[v];
        fixed[v] = fixed[v] || std::any_of(places.begin(), places.end(),
                                           [&](const FloatBox& box) { return box.contains(p); });
    });
}

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
    collapse.fixed.resize(mesh.points.size());
    for (int repeat = 0; repeat <= kMaxRepeats; ++repeat) {
        progress.stop_if_interrupted(100 * repeat / (kMaxRepeats + 1));
        TriangleMesh left = collapse_edges(mesh, collapse).mesh;
        const std::vector<FloatBox> places = spoiled_places(left);
        if (places.empty())
            return is_sound(left) ? Simplified{std::move(left), repeat} : Simplified{mesh, repeat};
        fix_vertices_in(places, repeat, tolerance, mesh, collapse.fixed);
    }
    return {mesh, kMaxRepeats};
}

} // namespace vdb_shell
