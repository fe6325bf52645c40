// SPDX-License-Identifier: Apache-2.0

// Takes: a direction for each vertex. Leaves: directions along which pillars can be longer: each
// triangle of a star bounds the pillar by a half-space, and visibility, the smallest cosine to
// their normals, says how much of it is left.

#include "growth/line_directions.h"

#include "core/parallel.h"
#include "core/unit_vector.h"
#include "mesh/most_visible.h"
#include "mesh/topology.h"

#include <algorithm>

namespace vdb_shell::growth
{
namespace
{

using openvdb::Vec3d;

/// Sum of the directions of the vertices beside v, those that point elsewhere or lie far away less
/// than others, unit length. On a closed surface each neighbour comes up twice, which cancels.
Vec3d mean_of_neighbours(const TriangleMesh& mesh, const VertexTriangles& around, std::size_t v,
                         const std::vector<Vec3d>& start, const std::vector<Vec3d>& now,
                         double least_cosine)
{
    Vec3d sum(0.0);
    for (const std::uint32_t t : around.around(v))
        for (int k = 0; k < 3; ++k) {
            const std::uint32_t u = mesh.triangles[t][k];
            const double weight = std::max(0.0, start[v].dot(start[u]) - least_cosine);
            const double length = (Vec3d(mesh.points[u]) - Vec3d(mesh.points[v])).length();
            if (u != v && length > 0)
                sum += now[u] * (weight * weight / length);
        }
    return unit_vector(sum);
}

} // namespace

void mend_directions(const TriangleMesh& mesh, Directions& directions,
                     const InitialSchedule& schedule)
{
    const VertexTriangles around = triangles_around_vertices(mesh.points.size(), mesh.triangles);
    for_each_index(mesh.points.size(), [&](std::size_t v) {
        if (directions.visibility[v] > schedule.poor_visibility)
            return;
        const std::vector<Vec3d> normals = star_normals(mesh, around.around(v));
        if (normals.empty())
            return;
        const Vec3d d = most_visible(normals);
        // Where no direction sees the whole star, as at some saddles, the given one may be as good.
        const double visibility = smallest_dot(normals, d);
        if (visibility <= directions.visibility[v])
            return;
        directions.inward[v] = d;
        directions.visibility[v] = visibility;
    });
}

void smooth_directions(const TriangleMesh& mesh, Directions& directions,
                       const InitialSchedule& schedule)
{
    const VertexTriangles around = triangles_around_vertices(mesh.points.size(), mesh.triangles);
    std::vector<std::vector<Vec3d>> normals(mesh.points.size());
    for_each_index(normals.size(),
                   [&](std::size_t v) { normals[v] = star_normals(mesh, around.around(v)); });
    // Weights come from the directions as they were given: from smoothed ones a crease would wear
    // away, pass by pass. Each pass reads a copy of what the last one left, so the order in which
    // vertices are visited has no effect.
    const std::vector<Vec3d> start = directions.inward;
    const std::vector<double> given = directions.visibility;
    for (int pass = 0; pass < schedule.smoothing_passes; ++pass) {
        const std::vector<Vec3d> old = directions.inward;
        for_each_index(mesh.points.size(), [&](std::size_t v) {
            if (given[v] <= 0)
                return;
            const Vec3d d = unit_vector(old[v] + mean_of_neighbours(mesh, around, v, start, old,
                                                                    schedule.smoothing_cosine));
            const double visibility = smallest_dot(normals[v], d);
            if (visibility <
                // The given visibility may be small already, at a sharp edge; then a share of it is
                // enough.
                std::min(schedule.kept_visibility, schedule.kept_visibility_share * given[v]))
                return;
            directions.inward[v] = d;
            directions.visibility[v] = visibility;
        });
    }
}

} // namespace vdb_shell::growth
