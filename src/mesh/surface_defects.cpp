// SPDX-License-Identifier: Apache-2.0

// Finds every defect of a surface, each list complete and ascending. Edges are counted by their
// triangles; vertices by whether the edges opposite to them form one path or one ring (the link
// condition of a surface); degenerate triangles and contacts by exact predicates, with no
// tolerance. A defect is listed once, as what it is: degenerate and duplicate triangles are left
// out of the contacts, where they would hide what really crosses. A surface without any defect is
// the closed manifold, embedded and oriented, that conditions 1 and 3 of docs/theory.md, "The whole
// shell", need.

#include "mesh/surface_defects.h"

#include "core/bucket_sort.h"
#include "core/disjoint_sets.h"
#include "core/exact.h"
#include "core/parallel.h"
#include "core/stage_stop.h"
#include "core/triangle_pairs.h"
#include "mesh/triangle_contacts.h"

#include <algorithm>
#include <functional>
#include <utility>

namespace vdb_shell
{
namespace
{

/// The indices whose flag is set. Flags are bytes, not vector<bool>, whose bits share words that
/// several threads would write at once.
template <typename Flags> std::vector<std::uint32_t> raised(const Flags& flags)
{
    std::vector<std::uint32_t> indices;
    for (std::uint32_t i = 0; i < flags.size(); ++i)
        if (flags[i])
            indices.push_back(i);
    return indices;
}

void look_at_edges(const EdgeUses& uses, SurfaceDefects& defects)
{
    for (std::size_t begin = 0, end = 0; begin < uses.size(); begin = end) {
        while (end < uses.size() && uses[end].edge == uses[begin].edge)
            ++end;
        const Edge& edge = uses[begin].edge;
        if (edge[0] == edge[1])
            continue; // of a triangle that is listed as degenerate
        if (end - begin == 1)
            defects.boundary_edges.push_back(edge);
        else if (end - begin > 2)
            defects.non_manifold_edges.push_back(edge);
        else if (uses[begin].forward == uses[begin + 1].forward)
            defects.inconsistent_edges.push_back(edge);
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
        // Such a triangle has no edge opposite to the vertex, and is listed as degenerate.
        if (corner[0] == corner[1] || corner[1] == corner[2] || corner[2] == corner[0])
            continue;
        for (int k = 0; k < 3; ++k)
            if (corner[k] != vertex)
                ends.emplace_back(corner[k], edges);
        ++edges;
    }
    std::sort(ends.begin(), ends.end());
    DisjointSets sets(edges);
    std::uint32_t pieces = edges;
    for (std::size_t i = 1; i < ends.size(); ++i) {
        if (ends[i].first != ends[i - 1].first)
            continue;
        // Three triangles at one edge of the vertex, where a point of a path or a ring has two
        // edges at most. If there is no such point, one connected piece is a path or a ring.
        if (i > 1 && ends[i].first == ends[i - 2].first)
            return false;
        pieces -= sets.join(ends[i - 1].second, ends[i].second);
    }
    return pieces <= 1;
}

std::vector<std::uint32_t> find_non_manifold_vertices(const TriangleMesh& mesh)
{
    const VertexTriangles star = triangles_around_vertices(mesh.points.size(), mesh.triangles);
    std::vector<char> bad(mesh.points.size());
    for_each_index(bad.size(), [&](std::size_t v) {
        bad[v] = !forms_one_fan(mesh, star.around(v), static_cast<std::uint32_t>(v));
    });
    return raised(bad);
}

std::array<std::uint32_t, 3> sorted_corners(const openvdb::Vec3I& triangle)
{
    std::array<std::uint32_t, 3> corners{triangle[0], triangle[1], triangle[2]};
    std::sort(corners.begin(), corners.end());
    return corners;
}

std::vector<std::uint32_t> find_duplicates(const TriangleMesh& mesh)
{
    using Entry = std::pair<std::array<std::uint32_t, 3>, std::uint32_t>;
    std::vector<Entry> entries;
    entries.reserve(mesh.triangles.size());
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t)
        entries.emplace_back(sorted_corners(mesh.triangles[t]), t);
    const std::vector<Entry> sorted = bucket_sort<Entry>(
        std::array{std::move(entries)}, mesh.points.size(),
        [](const Entry& entry) { return entry.first[0]; }, std::less<>());
    std::vector<char> duplicate(mesh.triangles.size());
    // The triangle's index is the second part of an entry, so the first of equal triangles stands
    // in front and is not counted.
    for (std::size_t i = 1; i < sorted.size(); ++i)
        duplicate[sorted[i].second] = sorted[i].first == sorted[i - 1].first;
    return raised(duplicate);
}

/// Degenerate triangles and repeats are listed as what they are. They get no box: the pairs among n
/// copies of one triangle would be n^2 / 2.
std::vector<char> left_out_of_contacts(std::size_t triangles, const SurfaceDefects& defects)
{
    std::vector<char> left_out(triangles);
    for (const auto* list : {&defects.degenerate_triangles, &defects.duplicate_triangles})
        for (const std::uint32_t t : *list)
            left_out[t] = 1;
    return left_out;
}

} // namespace

std::vector<char> find_degenerate(const std::vector<openvdb::Vec3s>& points,
                                  const std::vector<openvdb::Vec3I>& triangles)
{
    std::vector<char> degenerate(triangles.size());
    for_each_index(degenerate.size(), [&](std::size_t t) {
        const openvdb::Vec3I& corner = triangles[t];
        degenerate[t] = exact::collinear(points[corner[0]], points[corner[1]], points[corner[2]]);
    });
    return degenerate;
}

namespace
{

FoundPairs find_contacts(const TriangleMesh& mesh, const std::vector<char>& left_out,
                         const PairBounds& wanted, Interrupter* interrupter)
{
    const TriangleContacts contacts(mesh.points, mesh.triangles);
    return overlapping_triangles(
        mesh.points, mesh.triangles,
        [&](std::uint32_t first, std::uint32_t second) { return contacts.touch(first, second); },
        wanted, interrupter, left_out);
}

} // namespace

std::vector<TrianglePair> find_self_intersections(const TriangleMesh& mesh,
                                                  const std::vector<char>& left_out,
                                                  Interrupter* interrupter)
{
    return find_contacts(mesh, left_out, PairBounds{}, interrupter).pairs;
}

SurfaceDefects find_defects(const TriangleMesh& mesh, const EdgeUses& sorted_uses,
                            Interrupter* interrupter)
{
    SurfaceDefects defects;
    look_at_edges(sorted_uses, defects);
    stop_if_stage_wants();
    defects.non_manifold_vertices = find_non_manifold_vertices(mesh);
    stop_if_stage_wants();
    defects.degenerate_triangles = raised(find_degenerate(mesh.points, mesh.triangles));
    defects.duplicate_triangles = find_duplicates(mesh);
    PairBounds wanted;
    wanted.limited = true;
    FoundPairs found = find_contacts(mesh, left_out_of_contacts(mesh.triangles.size(), defects),
                                     wanted, interrupter);
    defects.self_intersections = std::move(found.pairs);
    defects.more_self_intersections = !found.all;
    return defects;
}

} // namespace vdb_shell
