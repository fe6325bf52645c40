// SPDX-License-Identifier: Apache-2.0

// Takes a surface of operations when they are done, and leaves it without gaps in its numbers, with
// both maps. A vertex of the input lies where its sample has wandered to, from patch to patch: so
// it stays on its own sheet where another one is as near. A vertex of the result was put onto the
// input, or is within the tolerance of it, and lies at the nearest point there.

#include "mesh/nearest_on_triangle.h"
#include "mesh/triangle_corners.h"
#include "resample/remesh_surface.h"

#include <algorithm>
#include <limits>

namespace vdb_shell
{
namespace
{

using openvdb::Vec3d;
using openvdb::Vec3I;

/// The weights of the nearest point of the triangle.
std::array<double, 3> weights_in(const std::array<Vec3d, 3>& corner, const Vec3d& p)
{
    const Vec3d to = nearest_on_triangle(corner, p).point;
    const Vec3d u = corner[1] - corner[0], v = corner[2] - corner[0], w = to - corner[0];
    const double uu = u.dot(u), uv = u.dot(v), vv = v.dot(v), wu = w.dot(u), wv = w.dot(v);
    const double determinant = uu * vv - uv * uv;
    if (!(determinant > 0)) {
        // So narrow that doubles see a segment: the nearest corner.
        std::size_t nearest = 0;
        for (std::size_t k = 1; k < 3; ++k)
            if ((corner[k] - to).lengthSqr() < (corner[nearest] - to).lengthSqr())
                nearest = k;
        std::array<double, 3> at{};
        at[nearest] = 1;
        return at;
    }
    const double b = std::clamp((vv * wu - uv * wv) / determinant, 0.0, 1.0);
    const double c = std::clamp((uu * wv - uv * wu) / determinant, 0.0, 1.0 - b);
    return {1.0 - b - c, b, c};
}

} // namespace

RemeshResult RemeshSurface::result() const
{
    RemeshResult out;
    std::vector<std::uint32_t> vertex(points_.size()), place(triangles_.size());
    TriangleTree::Seed seed = TriangleTree::kNoSeed;
    for (std::size_t v = 0; v < points_.size(); ++v) {
        if (star_[v].empty())
            continue;
        vertex[v] = static_cast<std::uint32_t>(out.mesh.points.size());
        out.mesh.points.push_back(points_[v]);
        const Vec3d p(points_[v]);
        const std::uint32_t t = tree_.nearest(p, 0.0F, seed).triangle;
        out.map.result_on_input.push_back(
            {t, input_.triangles[t], weights_in(triangle_corners(input_, t), p)});
    }
    for (std::uint32_t t = 0; t < triangles_.size(); ++t) {
        if (!alive(t))
            continue;
        const Vec3I& c = triangles_[t];
        place[t] = static_cast<std::uint32_t>(out.mesh.triangles.size());
        out.mesh.triangles.emplace_back(vertex[c[0]], vertex[c[1]], vertex[c[2]]);
    }
    out.map.input_on_result.resize(input_.points.size());
    for (std::uint32_t t = 0; t < triangles_.size(); ++t)
        for (const std::uint32_t s : samples_of_[t])
            if (s < input_.points.size())
                out.map.input_on_result[s] = {place[t], out.mesh.triangles[place[t]],
                                              weights_in(corners_of(triangles_[t]), samples_[s])};
    return out;
}

} // namespace vdb_shell
