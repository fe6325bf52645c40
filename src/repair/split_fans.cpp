// SPDX-License-Identifier: Apache-2.0

// Takes any triangles and gives each fan of triangles at a vertex a vertex of its own, so that
// growth has one fan around each vertex also on a surface that crosses itself (docs/theory.md, "A
// surface that crosses itself"). Unlike part_fans() it needs no orientation, keeps edges of three
// and more triangles as they are, and moves nothing: the copies count as a contact in a point. The
// first fan keeps the vertex, so a sound surface is not changed at all.

#include "vdb_shell/repair/split_fans.h"

#include "mesh/topology.h"

#include <utility>
#include <vector>

namespace vdb_shell
{
namespace
{

using Range = VertexTriangles::Range;

bool has_corner(const openvdb::Vec3I& triangle, std::uint32_t vertex)
{
    return triangle[0] == vertex || triangle[1] == vertex || triangle[2] == vertex;
}

bool share_an_edge_at(std::uint32_t vertex, const openvdb::Vec3I& first,
                      const openvdb::Vec3I& second)
{
    for (int k = 0; k < 3; ++k)
        if (first[k] != vertex && has_corner(second, first[k]))
            return true;
    return false;
}

/// The triangles of the star fan by fan, each fan and the list of them in ascending order of their
/// first triangles. Each member of a fan looks through what is left, so the time grows with the
/// square of the star, which is small.
std::vector<std::vector<std::uint32_t>> fans_at(const TriangleMesh& mesh, const Range& star,
                                                std::uint32_t vertex)
{
    std::vector<std::vector<std::uint32_t>> fans;
    std::vector<std::uint32_t> rest(star.begin(), star.end());
    while (!rest.empty()) {
        std::vector<std::uint32_t> fan{rest.front()}, left(rest.begin() + 1, rest.end());
        for (std::size_t i = 0; i < fan.size(); ++i) {
            rest.swap(left);
            left.clear();
            for (const std::uint32_t t : rest) {
                const bool joins =
                    share_an_edge_at(vertex, mesh.triangles[fan[i]], mesh.triangles[t]);
                (joins ? fan : left).push_back(t);
            }
        }
        rest.swap(left);
        fans.push_back(std::move(fan));
    }
    return fans;
}

} // namespace

FanSplit split_fans(TriangleMesh mesh)
{
    const std::size_t points = mesh.points.size();
    const VertexTriangles stars = triangles_around_vertices(points, mesh.triangles);
    FanSplit split;
    for (std::uint32_t v = 0; v < points; ++v) {
        const auto fans = fans_at(mesh, stars.around(v), v);
        if (fans.size() < 2)
            continue;
        if (split.vertices.count++ < Defect<std::uint32_t>::kFirstShown)
            split.vertices.first.push_back(v);
        for (std::size_t i = 1; i < fans.size(); ++i) {
            const auto copy = static_cast<std::uint32_t>(mesh.points.size());
            mesh.points.push_back(openvdb::Vec3s(mesh.points[v]));
            ++split.copies;
            for (const std::uint32_t t : fans[i])
                for (int k = 0; k < 3; ++k)
                    if (mesh.triangles[t][k] == v)
                        mesh.triangles[t][k] = copy;
        }
    }
    split.mesh = std::move(mesh);
    return split;
}

} // namespace vdb_shell
