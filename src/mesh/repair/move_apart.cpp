// SPDX-License-Identifier: Apache-2.0
#include "core/box_pairs.h"
#include "core/exact.h"
#include "core/parallel.h"
#include "mesh/repair/working_surface.h"
#include "vdb_shell/step/directions.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace vdb_shell::repair
{
namespace
{

using openvdb::Vec3d;
using openvdb::Vec3I;

/// How the copies of a point are moved: a share of their shortest edge, inward or (two cavities
/// that meet in a point) outward, the first of them too or not.
struct Attempt {
    double share;
    bool first_too;
};
// Small enough not to be seen, large enough for the shell to have room between.
constexpr std::array<Attempt, 12> kAttempts{{{1.0 / 16, false},
                                             {-1.0 / 16, false},
                                             {1.0 / 16, true},
                                             {-1.0 / 16, true},
                                             {1.0 / 128, false},
                                             {-1.0 / 128, false},
                                             {1.0 / 128, true},
                                             {-1.0 / 128, true},
                                             {1.0 / 1024, false},
                                             {-1.0 / 1024, false},
                                             {1.0 / 1024, true},
                                             {-1.0 / 1024, true}}};

double shortest_edge_at(const std::vector<openvdb::Vec3s>& points,
                        const std::vector<Vec3I>& triangles, const VertexTriangles& around,
                        std::uint32_t v)
{
    double shortest = std::numeric_limits<double>::infinity();
    for (const std::uint32_t t : around.around(v))
        for (int k = 0; k < 3; ++k) {
            const std::uint32_t u = triangles[t][k];
            if (u != v)
                shortest = std::min(shortest, (Vec3d(points[u]) - Vec3d(points[v])).length());
        }
    return std::isfinite(shortest) ? shortest : 0;
}

/// Triangles that cross or touch another one.
std::vector<char> crossing_triangles(const TriangleMesh& mesh)
{
    const auto pairs = overlapping_pairs(triangle_boxes(mesh.points, mesh.triangles));
    const auto flat = [&](const Vec3I& t) {
        return exact::collinear(mesh.points[t[0]], mesh.points[t[1]], mesh.points[t[2]]);
    };
    std::vector<char> touch(pairs.size());
    for_each_index(pairs.size(), [&](std::size_t i) {
        const Vec3I &a = mesh.triangles[pairs[i][0]], &b = mesh.triangles[pairs[i][1]];
        touch[i] = flat(a) || flat(b) || exact::triangles_touch(mesh.points, a, b);
    });
    std::vector<char> crossing(mesh.triangles.size());
    for (std::size_t i = 0; i < pairs.size(); ++i)
        for (const std::uint32_t t : pairs[i])
            crossing[t] |= touch[i];
    return crossing;
}

struct Mover {
    WorkingSurface& surface;
    VertexTriangles around;
    std::vector<openvdb::Vec3s> start;
    std::vector<Vec3d> outward;

    void place(const std::vector<std::uint32_t>& group, std::size_t attempt) const
    {
        for (std::size_t i = 0; i < group.size(); ++i) {
            const std::uint32_t v = group[i];
            openvdb::Vec3s& point = surface.mesh.points[v];
            point = start[v];
            if (attempt >= kAttempts.size() || (i == 0 && !kAttempts[attempt].first_too))
                continue;
            const double length = kAttempts[attempt].share *
                                  shortest_edge_at(start, surface.mesh.triangles, around, v);
            point = openvdb::Vec3s(Vec3d(start[v]) - outward[v] * length);
        }
    }

    bool crosses(const std::vector<std::uint32_t>& group, const std::vector<char>& crossing) const
    {
        return std::any_of(group.begin(), group.end(), [&](std::uint32_t v) {
            const auto range = around.around(v);
            return std::any_of(range.begin(), range.end(),
                               [&](std::uint32_t t) { return crossing[t] != 0; });
        });
    }
};

void note_moves(WorkingSurface& surface, const Mover& mover, RepairReport& report)
{
    TriangleMesh& mesh = surface.mesh;
    for (const std::vector<std::uint32_t>& group : surface.copies)
        for (const std::uint32_t v : group) {
            if (mesh.points[v] == mover.start[v])
                continue;
            ++report.moved_points;
            report.largest_move = std::max(
                report.largest_move, (Vec3d(mesh.points[v]) - Vec3d(mover.start[v])).length());
            for (const std::uint32_t t : mover.around.around(v))
                surface.source[t] = kNoSource;
        }
}

} // namespace

void move_copies_apart(WorkingSurface& surface, RepairReport& report)
{
    if (surface.copies.empty())
        return;
    const TriangleMesh& mesh = surface.mesh;
    const Mover mover{surface, triangles_around_vertices(mesh.points.size(), mesh.triangles),
                      mesh.points, pseudo_normals(mesh)};
    std::vector<std::size_t> attempt(surface.copies.size(), 0);
    // One round more than there are attempts puts back those that no attempt helped.
    for (std::size_t round = 0; round <= kAttempts.size(); ++round) {
        for (std::size_t g = 0; g < attempt.size(); ++g)
            mover.place(surface.copies[g], attempt[g]);
        const std::vector<char> crossing = crossing_triangles(mesh);
        bool any = false;
        for (std::size_t g = 0; g < attempt.size(); ++g) {
            if (attempt[g] == kAttempts.size() || !mover.crosses(surface.copies[g], crossing))
                continue;
            ++attempt[g];
            any = true;
        }
        if (!any)
            break;
    }
    for (std::size_t g = 0; g < attempt.size(); ++g)
        mover.place(surface.copies[g], attempt[g]);
    note_moves(surface, mover, report);
}

} // namespace vdb_shell::repair
