// SPDX-License-Identifier: Apache-2.0

// Takes: a direction for each vertex. Leaves: directions along which pillars can be longer: each
// triangle of a star bounds the pillar by a half-space, and visibility, the smallest cosine to
// their normals, says how much of it is left.

#include "growth/line_directions.h"

#include "core/parallel.h"
#include "mesh/topology.h"

#include <algorithm>
#include <limits>

namespace vdb_shell::growth
{
namespace
{

using openvdb::Vec3d;
using openvdb::Vec3I;

// The optimum over a star touches at most three normals, so all triples are tried; with more
// normals than this an iteration is cheaper.
constexpr std::size_t kSmallStar = 16;

Vec3d unit_or_zero(const Vec3d& v)
{
    const double length = v.length();
    return length > 0 ? v / length : Vec3d(0.0);
}

double smallest_dot(const std::vector<Vec3d>& normals, const Vec3d& d)
{
    double least = std::numeric_limits<double>::infinity();
    for (const Vec3d& n : normals)
        least = std::min(least, n.dot(d));
    return least;
}

Vec3d most_visible_of_few(const std::vector<Vec3d>& n)
{
    Vec3d best(0.0);
    double best_dot = -2;
    // At the best direction one, two or three normals have the smallest dot product together: it is
    // one of the normals, or halfway between two, or as far from each of three.
    const auto consider = [&](const Vec3d& candidate) {
        const Vec3d d = unit_or_zero(candidate);
        const double dot = smallest_dot(n, d);
        if (d.lengthSqr() > 0 && dot > best_dot) {
            best_dot = dot;
            best = d;
        }
    };
    for (std::size_t i = 0; i < n.size(); ++i) {
        consider(n[i]);
        for (std::size_t j = 0; j < i; ++j) {
            consider(n[i] + n[j]);
            for (std::size_t l = 0; l < j; ++l) {
                const Vec3d c = (n[j] - n[i]).cross(n[l] - n[i]);
                consider(c);
                consider(-c);
            }
        }
    }
    return best;
}

/// The direction sought is that of the point of the normals' hull nearest the origin (Gilbert 1966,
/// "An iterative procedure for computing the minimum of a quadratic form on a convex set").
Vec3d most_visible_of_many(const std::vector<Vec3d>& n)
{
    // Far more than any star of the meshes tried needed: a bound for termination.
    constexpr int kIterations = 4000;
    Vec3d p = n[0];
    for (int i = 0; i < kIterations; ++i) {
        const Vec3d lowest =
            *std::min_element(n.begin(), n.end(),
                              [&](const Vec3d& x, const Vec3d& y) { return x.dot(p) < y.dot(p); });
        const Vec3d edge = lowest - p;
        const double squared = edge.lengthSqr();
        if (squared <= 0)
            break;
        const double t = std::clamp(-p.dot(edge) / squared, 0.0, 1.0);
        if (t <= 0)
            break;
        p += t * edge;
    }
    return unit_or_zero(p);
}

/// By vertex, the inward unit normals of its triangles; those without area have none.
std::vector<std::vector<Vec3d>> star_normals(const TriangleMesh& mesh)
{
    std::vector<std::vector<Vec3d>> normals(mesh.points.size());
    for (const Vec3I& t : mesh.triangles) {
        const Vec3d a(mesh.points[t[0]]);
        const Vec3d n =
            unit_or_zero((Vec3d(mesh.points[t[2]]) - a).cross(Vec3d(mesh.points[t[1]]) - a));
        for (int k = 0; k < 3 && n.lengthSqr() > 0; ++k)
            normals[t[k]].push_back(n);
    }
    return normals;
}

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
    return unit_or_zero(sum);
}

} // namespace

Vec3d most_visible(const std::vector<Vec3d>& normals)
{
    if (normals.empty())
        return Vec3d(0.0);
    // Both ways give the optimum; they differ in rounding alone.
    return normals.size() <= kSmallStar ? most_visible_of_few(normals)
                                        : most_visible_of_many(normals);
}

void mend_directions(const TriangleMesh& mesh, Directions& directions,
                     const InitialSchedule& schedule)
{
    const std::vector<std::vector<Vec3d>> normals = star_normals(mesh);
    for_each_index(mesh.points.size(), [&](std::size_t v) {
        if (normals[v].empty() || directions.visibility[v] > schedule.poor_visibility)
            return;
        const Vec3d d = most_visible(normals[v]);
        // Where no direction sees the whole star, as at some saddles, the given one may be as good.
        const double visibility = smallest_dot(normals[v], d);
        if (visibility <= directions.visibility[v])
            return;
        directions.inward[v] = d;
        directions.visibility[v] = visibility;
    });
}

void smooth_directions(const TriangleMesh& mesh, Directions& directions,
                       const InitialSchedule& schedule)
{
    const std::vector<std::vector<Vec3d>> normals = star_normals(mesh);
    const VertexTriangles around = triangles_around_vertices(mesh.points.size(), mesh.triangles);
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
            const Vec3d d = unit_or_zero(old[v] + mean_of_neighbours(mesh, around, v, start, old,
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
