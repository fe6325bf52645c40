// SPDX-License-Identifier: Apache-2.0
#include "core/box_pairs.h"
#include "core/exact.h"
#include "core/parallel.h"
#include "mesh/components.h"
#include "mesh/surface_defects.h"
#include "repair/working_surface.h"

#include <algorithm>

namespace vdb_shell::repair
{
namespace
{

using openvdb::Vec3d;
using openvdb::Vec3I;

// An open piece with less of the area than this is a rag that the cut left.
constexpr double kRag = 0.01;

/// Marks all triangles with a corner in common with a marked one.
void add_ring(const TriangleMesh& mesh, std::vector<char>& marked)
{
    std::vector<char> points(mesh.points.size());
    for (std::size_t t = 0; t < marked.size(); ++t)
        for (int k = 0; k < 3 && marked[t]; ++k)
            points[mesh.triangles[t][k]] = 1;
    for (std::size_t t = 0; t < marked.size(); ++t)
        for (int k = 0; k < 3; ++k)
            marked[t] |= points[mesh.triangles[t][k]];
}

void mark_rims(const TriangleMesh& mesh, std::vector<char>& marked)
{
    const std::vector<EdgeUse> uses = sorted_edge_uses(mesh.triangles);
    for (std::size_t begin = 0, end = 0; begin < uses.size(); begin = end) {
        while (end < uses.size() && uses[end].edge == uses[begin].edge)
            ++end;
        if (end - begin == 1)
            marked[uses[begin].triangle] = 1;
    }
}

void note(const WorkingSurface& surface, const std::vector<char>& drop, RepairReport& report)
{
    for (std::size_t t = 0; t < drop.size(); ++t)
        if (drop[t] && surface.source[t] != kNoSource)
            add_to(report.cut, surface.source[t]);
}

/// The triangles of small open pieces.
std::vector<char> find_rags(const TriangleMesh& mesh)
{
    const std::vector<EdgeUse> uses = sorted_edge_uses(mesh.triangles);
    const std::vector<std::uint32_t> component_of =
        component_of_triangles(uses, mesh.triangles.size());
    std::vector<double> area;
    double all = 0;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        const Vec3I& corner = mesh.triangles[t];
        const Vec3d a(mesh.points[corner[0]]);
        const double twice =
            (Vec3d(mesh.points[corner[1]]) - a).cross(Vec3d(mesh.points[corner[2]]) - a).length();
        if (component_of[t] >= area.size())
            area.resize(component_of[t] + 1);
        area[component_of[t]] += twice;
        all += twice;
    }
    std::vector<char> open(area.size());
    for (std::size_t begin = 0, end = 0; begin < uses.size(); begin = end) {
        while (end < uses.size() && uses[end].edge == uses[begin].edge)
            ++end;
        if (end - begin == 1)
            open[component_of[uses[begin].triangle]] = 1;
    }
    std::vector<char> rag(mesh.triangles.size());
    for (std::size_t t = 0; t < rag.size(); ++t)
        rag[t] = open[component_of[t]] && area[component_of[t]] < kRag * all;
    return rag;
}

} // namespace

/// Triangles that cross or touch another one.
std::vector<char> crossing_triangles(const TriangleMesh& mesh)
{
    const auto flat = [&](const Vec3I& t) {
        return exact::collinear(mesh.points[t[0]], mesh.points[t[1]], mesh.points[t[2]]);
    };
    const auto touch = [&](std::uint32_t first, std::uint32_t second) {
        const Vec3I &a = mesh.triangles[first], &b = mesh.triangles[second];
        return flat(a) || flat(b) || exact::triangles_touch(mesh.points, a, b);
    };
    std::vector<char> crossing(mesh.triangles.size());
    for (const auto& [a, b] : overlapping_pairs(triangle_boxes(mesh.points, mesh.triangles), touch))
        crossing[a] = crossing[b] = 1;
    return crossing;
}

bool cut_crossings(WorkingSurface& surface, int round, RepairReport& report)
{
    std::vector<char> drop = crossing_triangles(surface.mesh);
    // A hole that the last cut left and no fill could close needs room as well.
    if (round > 0)
        mark_rims(surface.mesh, drop);
    if (std::find(drop.begin(), drop.end(), char(1)) == drop.end())
        return false;
    for (int ring = 0; ring + 1 < round; ++ring)
        add_ring(surface.mesh, drop);
    note(surface, drop, report);
    drop_triangles(surface, drop);
    drop = find_rags(surface.mesh);
    note(surface, drop, report);
    drop_triangles(surface, drop);
    return true;
}

} // namespace vdb_shell::repair
