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
using openvdb::Vec3d;
using openvdb::Vec3I;

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
            {t, input_.triangles[t], nearest_weights(triangle_corners(input_, t), p)});
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
                out.map.input_on_result[s] = {
                    place[t], out.mesh.triangles[place[t]],
                    nearest_weights(corners_of(triangles_[t]), samples_[s])};
    return out;
}

} // namespace vdb_shell
