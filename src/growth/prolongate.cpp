// SPDX-License-Identifier: Apache-2.0

// Takes: the shell of a coarser surface and the vertices of a finer one. Gives: for each vertex a
// pillar that ends where the coarse shell ends under it. Nothing is tested here; mend_prolonged
// makes a valid shell of it. Prolongation as in multigrid methods: linear within each coarse prism.

#include "growth/prolongate.h"

#include "core/parallel.h"
#include "mesh/nearest_on_triangle.h"
#include "mesh/triangle_corners.h"
#include "mesh/triangle_tree.h"
#include "vdb_shell/mesh/normals.h"

#include <array>
#include <cmath>
#include <utility>

namespace vdb_shell::growth
{
namespace
{

using openvdb::Vec3d;
using openvdb::Vec3s;

// Prolonged pillars miss their caps by how far the two surfaces are beside each other.
constexpr double kShareOfCap = 0.9;

/// Barycentric coordinates of a point of the triangle; those of its middle where it has no area.
std::array<double, 3> weights_in(const std::array<Vec3d, 3>& corner, const Vec3d& at)
{
    const Vec3d n = (corner[1] - corner[0]).cross(corner[2] - corner[0]);
    const double squared = n.lengthSqr();
    std::array<double, 3> weight{};
    for (std::size_t k = 0; k < 3; ++k) {
        const Vec3d &p = corner[(k + 1) % 3], &q = corner[(k + 2) % 3];
        weight[k] = squared > 0 ? n.dot((q - p).cross(at - p)) / squared : 1.0 / 3.0;
    }
    return weight;
}

/// Where a pillar ends that starts at this point of the coarse surface: at the point with the same
/// barycentric coordinates on the inner triangle.
Vec3d end_in_prism(const TriangleMesh& coarse, const std::vector<Vec3d>& inner,
                   const CoarsePoint& at)
{
    const openvdb::Vec3I& t = coarse.triangles[at.triangle];
    Vec3d end(0.0);
    for (std::size_t k = 0; k < 3; ++k)
        end += at.weight[k] * inner[t[static_cast<int>(k)]];
    return end;
}

/// Each point halfway to the mean of its neighbours, in so many passes, but for those that are
/// held. A coarse triangle is mapped to its inner one as a whole, so a finer surface's inner points
/// lie in patches with kinks between them, and dense on one side of a kink, sparse on the other:
/// that is where prisms are sheared. The points of the inner surface are averaged and not the
/// pillars, for these would carry the outer surface's roughness there. Neighbours count by the
/// inverse square of how far they are on the outer surface, or needles would drag points along for
/// all their length. What it is worth: docs/measurements/tried.md, "Fair inner surfaces".
std::vector<Vec3d> fair(const TriangleMesh& mesh, const Connectivity& connectivity,
                        std::vector<Vec3d> points, const std::vector<std::uint8_t>& held,
                        int passes)
{
    std::vector<Vec3d> next(points.size());
    for (int pass = 0; pass < passes; ++pass) {
        for_each_index(points.size(), [&](std::size_t v) {
            Vec3d sum(0.0);
            double weights = 0;
            for (const int u : neighbours(connectivity, static_cast<int>(v))) {
                const double squared = (Vec3d(mesh.points[u]) - Vec3d(mesh.points[v])).lengthSqr();
                if (squared > 0)
                    sum += points[u] / squared, weights += 1 / squared;
            }
            next[v] = !held[v] && weights > 0 ? 0.5 * (points[v] + sum / weights) : points[v];
        });
        points.swap(next);
    }
    return points;
}

/// The inner points under the vertices, made fair.
std::vector<Vec3s> prolonged_points(const TriangleMesh& coarse,
                                    const std::vector<Vec3d>& coarse_inner,
                                    const TriangleMesh& mesh, const Connectivity& connectivity,
                                    const std::vector<double>& cap,
                                    const std::vector<CoarsePoint>& nearest, int fair_passes)
{
    std::vector<Vec3d> ends(mesh.points.size());
    std::vector<std::uint8_t> held(ends.size());
    for_each_index(ends.size(), [&](std::size_t v) {
        ends[v] = end_in_prism(coarse, coarse_inner, nearest[v]);
        // As thick as is allowed: nothing is to be won, and where the next is allowed less, lost.
        held[v] = (ends[v] - Vec3d(mesh.points[v])).length() > kShareOfCap * cap[v];
    });
    ends = fair(mesh, connectivity, std::move(ends), held, fair_passes);
    return {ends.begin(), ends.end()};
}

} // namespace

Pillars pillars_to(const TriangleMesh& mesh, const std::vector<Vec3s>& inner, Directions lines)
{
    Pillars pillars{std::move(lines), std::vector<double>(inner.size())};
    for_each_index(inner.size(), [&](std::size_t v) {
        const Vec3d arm = Vec3d(inner[v]) - Vec3d(mesh.points[v]);
        pillars.length[v] = arm.length();
        if (pillars.length[v] > 0)
            pillars.lines.inward[v] = arm / pillars.length[v];
    });
    return pillars;
}

std::vector<CoarsePoint> nearest_coarse_points(const TriangleMesh& mesh, const TriangleMesh& coarse,
                                               const MultilevelSchedule& schedule)
{
    // Each vertex looks for its own nearest triangle without a seed from another, so that the
    // result does not depend on how the vertices are shared among threads.
    const TriangleTree tree(coarse, diagonal_of(bounds_of(coarse.points)));
    std::vector<CoarsePoint> points(mesh.points.size());
    for_each_index(points.size(), [&](std::size_t v) {
        const Vec3d at(mesh.points[v]);
        // Within the tolerance any triangle will do: what is made of it is tested anyway.
        TriangleTree::Seed seed = TriangleTree::kNoSeed;
        const std::uint32_t t = tree.nearest(at, schedule.nearest_tolerance, seed).triangle;
        const std::array<Vec3d, 3> corner = triangle_corners(coarse, t);
        points[v] = {t, weights_in(corner, nearest_on_triangle(corner, at).point)};
    });
    return points;
}

Pillars prolonged_pillars(const TriangleMesh& coarse, const std::vector<Vec3d>& coarse_inner,
                          const TriangleMesh& mesh, const Connectivity& connectivity,
                          const std::vector<double>& cap, const std::vector<CoarsePoint>& nearest,
                          const Directions& lines, const MultilevelSchedule& schedule)
{
    Pillars pillars = pillars_to(mesh,
                                 prolonged_points(coarse, coarse_inner, mesh, connectivity, cap,
                                                  nearest, schedule.fair_passes),
                                 lines);
    // A pillar that its own triangles hide would be shortened to nothing by mending.
    std::vector<Vec3d> outward(mesh.points.size());
    for_each_index(outward.size(), [&](std::size_t v) { outward[v] = -pillars.lines.inward[v]; });
    const std::vector<double> visibility = visibility_of(mesh, outward);
    for_each_index(outward.size(), [&](std::size_t v) {
        if (!(visibility[v] > schedule.least_visibility))
            pillars.lines.inward[v] = lines.inward[v];
    });
    return pillars;
}

} // namespace vdb_shell::growth
