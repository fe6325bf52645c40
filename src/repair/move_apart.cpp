// SPDX-License-Identifier: Apache-2.0
#include "repair/working_surface.h"
#include "vdb_shell/mesh/normals.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>

namespace vdb_shell::repair
{
namespace
{

using openvdb::Vec3d;
using openvdb::Vec3I;

/// How far the copies of a point are moved: a share of their shortest edge; the first of them too
/// or not.
struct Attempt {
    double share;
    bool first_too;
};
// Small enough not to be seen, large enough for the shell to have room between.
constexpr std::array<Attempt, 6> kAttempts{{{1.0 / 16, false},
                                            {1.0 / 16, true},
                                            {1.0 / 64, false},
                                            {1.0 / 64, true},
                                            {1.0 / 512, false},
                                            {1.0 / 512, true}}};

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

/// Whether a direction from the top of a cone of triangles points out of the solid: by the normal
/// of the nearest face or edge of the cone, or of its top (Baerentzen and Aanaes 2005, "Signed
/// distance computation using the angle weighted pseudonormal").
bool points_outside(const TriangleMesh& mesh, const VertexTriangles::Range& cone, std::uint32_t top,
                    const Vec3d& top_normal, const Vec3d& direction)
{
    const Vec3d origin(mesh.points[top]);
    const Vec3d d = direction / direction.length();
    double nearest = 0; // cosine of the angle to the feature; the top is at a right angle
    double side = d.dot(top_normal);
    std::map<std::uint32_t, Vec3d> edge_normals;
    for (const std::uint32_t t : cone) {
        const Vec3I& corner = mesh.triangles[t];
        const int k = corner[0] == top ? 0 : corner[1] == top ? 1 : 2;
        const std::uint32_t p = corner[(k + 1) % 3], q = corner[(k + 2) % 3];
        const Vec3d a = Vec3d(mesh.points[p]) - origin, b = Vec3d(mesh.points[q]) - origin;
        Vec3d normal = a.cross(b);
        normal.normalize();
        for (const std::uint32_t end : {p, q})
            edge_normals.try_emplace(end, Vec3d(0.0)).first->second += normal;
        const Vec3d flat = d - normal * d.dot(normal);
        const bool within = normal.dot(a.cross(flat)) >= 0 && normal.dot(flat.cross(b)) >= 0;
        if (within && flat.length() > nearest) {
            nearest = flat.length();
            side = d.dot(normal);
        }
    }
    for (const auto& [end, normal] : edge_normals) {
        const Vec3d along = Vec3d(mesh.points[end]) - origin;
        const double cosine = d.dot(along) / along.length();
        if (cosine <= nearest)
            continue;
        nearest = cosine;
        side = d.dot(normal);
    }
    return side >= 0;
}

struct Mover {
    WorkingSurface& surface;
    VertexTriangles around;
    std::vector<openvdb::Vec3s> start;
    std::vector<Vec3d> outward;
    std::vector<char> shrinks_void; ///< by point: what it moves away from is in its solid

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
            // Into its own solid, or, of two cavities that meet, into its own cavity.
            point =
                openvdb::Vec3s(Vec3d(start[v]) - outward[v] * (shrinks_void[v] ? -length : length));
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

/// Where the other copies' triangles are, seen from each copy: beyond its surface or in its solid.
void find_ways(const std::vector<std::uint32_t>& group, Mover& mover)
{
    const TriangleMesh& mesh = mover.surface.mesh;
    for (const std::uint32_t v : group)
        for (const std::uint32_t other : group) {
            const auto cone = mover.around.around(other);
            if (other == v || cone.size() == 0 || mover.around.around(v).size() == 0)
                continue;
            const Vec3I& t = mesh.triangles[*cone.begin()];
            const Vec3d middle =
                (Vec3d(mesh.points[t[0]]) + Vec3d(mesh.points[t[1]]) + Vec3d(mesh.points[t[2]])) /
                3.0;
            const Vec3d direction = middle - Vec3d(mesh.points[v]);
            if (direction.length() > 0 &&
                !points_outside(mesh, mover.around.around(v), v, mover.outward[v], direction))
                mover.shrinks_void[v] = 1;
        }
}

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
    Mover mover{surface, triangles_around_vertices(mesh.points.size(), mesh.triangles), mesh.points,
                pseudo_normals(mesh), std::vector<char>(mesh.points.size())};
    for (const std::vector<std::uint32_t>& group : surface.copies)
        find_ways(group, mover);
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
