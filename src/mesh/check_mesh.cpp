// SPDX-License-Identifier: Apache-2.0
#include "vdb_shell/mesh/check_mesh.h"

#include "core/box_pairs.h"
#include "core/exact.h"
#include "core/parallel.h"
#include "mesh/components.h"
#include "mesh/topology.h"
#include "vdb_shell/core/error.h"

#include <algorithm>
#include <numeric>
#include <utility>

namespace vdb_shell
{
namespace
{

template <typename Element> void add_to(Defect<Element>& defect, const Element& element)
{
    if (defect.count++ < Defect<Element>::kFirstShown)
        defect.first.push_back(element);
}

template <typename Flags> Defect<std::uint32_t> raised(const Flags& flags)
{
    Defect<std::uint32_t> defect;
    for (std::uint32_t i = 0; i < flags.size(); ++i)
        if (flags[i])
            add_to(defect, i);
    return defect;
}

void require_well_formed(const TriangleMesh& mesh)
{
    for (std::size_t v = 0; v < mesh.points.size(); ++v)
        if (!mesh.points[v].isFinite())
            throw InvalidOption("check_mesh: point " + std::to_string(v) + " is " +
                                mesh.points[v].str() + ", which is not finite");
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
        for (int corner = 0; corner < 3; ++corner)
            if (mesh.triangles[t][corner] >= mesh.points.size())
                throw InvalidOption("check_mesh: triangle " + std::to_string(t) +
                                    " has the point index " +
                                    std::to_string(mesh.triangles[t][corner]) + ", there are " +
                                    std::to_string(mesh.points.size()) + " points");
}

void check_edges(const std::vector<EdgeUse>& uses, MeshCheck& check)
{
    for (std::size_t begin = 0, end = 0; begin < uses.size(); begin = end) {
        while (end < uses.size() && uses[end].edge == uses[begin].edge)
            ++end;
        const Edge& edge = uses[begin].edge;
        if (edge[0] == edge[1])
            continue; // of a triangle that is listed as degenerate
        if (end - begin == 1)
            add_to(check.boundary_edges, edge);
        else if (end - begin > 2)
            add_to(check.non_manifold_edges, edge);
        else if (uses[begin].forward == uses[begin + 1].forward)
            add_to(check.inconsistent_edges, edge);
    }
}

/// Whether the triangles around `vertex` form one fan: the edges opposite to the vertex one path or
/// one ring.
bool forms_one_fan(const TriangleMesh& mesh, const VertexTriangles::Range& around,
                   std::uint32_t vertex)
{
    // An end of an opposite edge, with the number of the edge.
    std::vector<std::pair<std::uint32_t, std::uint32_t>> ends;
    std::uint32_t edges = 0;
    for (const std::uint32_t t : around) {
        const openvdb::Vec3I& corner = mesh.triangles[t];
        if (corner[0] == corner[1] || corner[1] == corner[2] || corner[2] == corner[0])
            continue;
        for (int k = 0; k < 3; ++k)
            if (corner[k] != vertex)
                ends.emplace_back(corner[k], edges);
        ++edges;
    }
    std::sort(ends.begin(), ends.end());
    std::vector<std::uint32_t> parent(edges);
    std::iota(parent.begin(), parent.end(), 0U);
    auto root_of = [&](std::uint32_t i) {
        while (parent[i] != i)
            i = parent[i] = parent[parent[i]];
        return i;
    };
    std::uint32_t pieces = edges;
    for (std::size_t i = 1; i < ends.size(); ++i) {
        if (ends[i].first != ends[i - 1].first)
            continue;
        if (i > 1 && ends[i].first == ends[i - 2].first)
            return false;
        const std::uint32_t a = root_of(ends[i - 1].second), b = root_of(ends[i].second);
        pieces -= a != b;
        parent[a] = b;
    }
    return pieces <= 1;
}

Defect<std::uint32_t> find_non_manifold_vertices(const TriangleMesh& mesh)
{
    const VertexTriangles star = triangles_around_vertices(mesh.points.size(), mesh.triangles);
    std::vector<char> bad(mesh.points.size());
    for_each_index(bad.size(), [&](std::size_t v) {
        bad[v] = !forms_one_fan(mesh, star.around(v), static_cast<std::uint32_t>(v));
    });
    return raised(bad);
}

std::vector<char> find_degenerate(const TriangleMesh& mesh)
{
    std::vector<char> degenerate(mesh.triangles.size());
    for_each_index(degenerate.size(), [&](std::size_t t) {
        const openvdb::Vec3I& corner = mesh.triangles[t];
        degenerate[t] = exact::collinear(mesh.points[corner[0]], mesh.points[corner[1]],
                                         mesh.points[corner[2]]);
    });
    return degenerate;
}

std::array<std::uint32_t, 3> sorted_corners(const openvdb::Vec3I& triangle)
{
    std::array<std::uint32_t, 3> corners{triangle[0], triangle[1], triangle[2]};
    std::sort(corners.begin(), corners.end());
    return corners;
}

Defect<std::uint32_t> find_duplicates(const TriangleMesh& mesh)
{
    std::vector<std::pair<std::array<std::uint32_t, 3>, std::uint32_t>> sorted;
    sorted.reserve(mesh.triangles.size());
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t)
        sorted.emplace_back(sorted_corners(mesh.triangles[t]), t);
    std::sort(sorted.begin(), sorted.end());
    std::vector<char> duplicate(mesh.triangles.size());
    for (std::size_t i = 1; i < sorted.size(); ++i)
        duplicate[sorted[i].second] = sorted[i].first == sorted[i - 1].first;
    return raised(duplicate);
}

std::vector<TrianglePair> find_self_intersections(const TriangleMesh& mesh,
                                                  const std::vector<char>& degenerate)
{
    const std::vector<TrianglePair> pairs =
        overlapping_pairs(triangle_boxes(mesh.points, mesh.triangles));
    std::vector<char> touching(pairs.size());
    for_each_index(pairs.size(), [&](std::size_t i) {
        const auto [first, second] = pairs[i];
        const openvdb::Vec3I &a = mesh.triangles[first], &b = mesh.triangles[second];
        // Degenerate and duplicate triangles are listed as what they are.
        touching[i] = !degenerate[first] && !degenerate[second] &&
                      sorted_corners(a) != sorted_corners(b) &&
                      exact::triangles_touch(mesh.points, a, b);
    });
    std::vector<TrianglePair> found;
    for (std::size_t i = 0; i < pairs.size(); ++i)
        if (touching[i])
            found.push_back(pairs[i]);
    return found;
}

/// The pairs of different components to which the pairs of triangles belong, sorted.
std::vector<std::array<std::uint32_t, 2>>
crossing_components(const std::vector<TrianglePair>& pairs,
                    const std::vector<std::uint32_t>& component_of)
{
    std::vector<std::array<std::uint32_t, 2>> crossing;
    for (const TrianglePair& pair : pairs) {
        const auto [low, high] = std::minmax(component_of[pair[0]], component_of[pair[1]]);
        if (low != high)
            crossing.push_back({low, high});
    }
    std::sort(crossing.begin(), crossing.end());
    crossing.erase(std::unique(crossing.begin(), crossing.end()), crossing.end());
    return crossing;
}

} // namespace

std::size_t MeshCheck::inside_out_components() const
{
    return static_cast<std::size_t>(std::count_if(components.begin(), components.end(),
                                                  [](const Component& c) { return c.inside_out; }));
}

MeshCheck check_mesh(const TriangleMesh& mesh)
{
    require_well_formed(mesh);
    MeshCheck check;
    check.points = mesh.points.size();
    check.triangles = mesh.triangles.size();
    const std::vector<EdgeUse> uses = sorted_edge_uses(mesh.triangles);
    check_edges(uses, check);
    check.non_manifold_vertices = find_non_manifold_vertices(mesh);
    const std::vector<char> degenerate = find_degenerate(mesh);
    check.degenerate_triangles = raised(degenerate);
    check.duplicate_triangles = find_duplicates(mesh);
    const std::vector<TrianglePair> pairs = find_self_intersections(mesh, degenerate);
    for (const TrianglePair& pair : pairs)
        add_to(check.self_intersections, pair);
    const std::vector<std::uint32_t> component_of =
        component_of_triangles(uses, mesh.triangles.size());
    check.components =
        describe_components(mesh, uses, component_of, crossing_components(pairs, component_of));
    for (const Component& component : check.components)
        check.volume += component.volume;
    return check;
}

TriangleMesh turn_outward(TriangleMesh mesh, const MeshCheck& check)
{
    const std::vector<std::uint32_t> component =
        component_of_triangles(sorted_edge_uses(mesh.triangles), mesh.triangles.size());
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
        if (check.components.at(component[t]).inside_out)
            std::swap(mesh.triangles[t][1], mesh.triangles[t][2]);
    return mesh;
}

} // namespace vdb_shell
