// SPDX-License-Identifier: Apache-2.0

// Takes an embedded surface and leaves a coarser one that is embedded too, where that can be had.
// Edge collapses know nothing of triangles that are not neighbours, so exact tests look for
// contacts afterwards, and for components that have turned inside out. The vertices around these
// are fixed, and the collapses begin anew from the input; undoing single collapses would need their
// history. Fixed vertices only become more, so each repeat is nearer to the input, which is
// embedded.

#include "resample/collapse_embedded.h"

#include "core/box_pairs.h"
#include "core/parallel.h"
#include "resample/component_sides.h"
#include "resample/spoiled_triangles.h"

#include <algorithm>
#include <utility>

namespace vdb_shell
{
namespace
{

using openvdb::Vec3s;

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

} // namespace

EmbeddedCollapse collapse_embedded(const TriangleMesh& mesh, CollapseLimits limits,
                                   int most_repeats, const StageProgress& progress)
{
    limits.fixed.resize(mesh.points.size());
    const ComponentSides sides(mesh);
    for (int repeat = 0;; ++repeat) {
        progress.stop_if_interrupted(100.0 * repeat / (most_repeats + 1));
        Coarsened left = collapse_edges(mesh, limits);
        std::vector<FloatBox> places = spoiled_places(left.mesh);
        const bool embedded = !sides.hold_turned(left, limits.fixed) && places.empty();
        if (embedded || repeat == most_repeats)
            return {std::move(left), repeat, embedded};
        fix_vertices_in(std::move(places), repeat, limits.distance, mesh, limits.fixed);
    }
}

} // namespace vdb_shell
