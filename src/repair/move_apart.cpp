// SPDX-License-Identifier: Apache-2.0

// Takes copies of points that were parted and stand in one place, which is a contact of the surface
// with itself (docs/theory.md, "The whole shell"), and moves them a little into their own solid, or
// where two cavities met, into their own cavity. All groups make an attempt at the same time, then
// the exact test looks for crossings on the whole surface, and groups that cross go on to the next
// attempt. A group for which none succeeds is put back. Moves are measured on the places at the
// start, so the order of groups does not matter. Largest and number of moves are reported.

#include "core/parallel.h"
#include "core/unit_vector.h"
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

/// How far the copies of a point are moved, as a share of their shortest edge, and whether the
/// first copy moves as well.
struct Attempt {
    double share;
    bool first_too;
};
// The first share is small enough not to be seen and large enough for the shell to have room
// between. Each share is tried with the first copy in its place before all are moved, for a point
// that stays keeps its triangles bit for bit.
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
/// distance computation using the angle weighted pseudonormal"). A cone looks alike at every scale,
/// so one unit along the direction stands for all: the nearest feature is the one at the smallest
/// angle, if that is less than a right angle, and else the top.
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
        const Vec3d normal = unit_vector(a.cross(b));
        for (const std::uint32_t end : {p, q})
            edge_normals.try_emplace(end, Vec3d(0.0)).first->second += normal;
        // The foot of the direction on the plane of the face; it counts if it lies in the sector of
        // the face.
        const Vec3d flat = d - normal * d.dot(normal);
        const bool within = normal.dot(a.cross(flat)) >= 0 && normal.dot(flat.cross(b)) >= 0;
        if (within && flat.length() > nearest) {
            nearest = flat.length();
            side = d.dot(normal);
        }
    }
    // An edge weighs its two faces alike, so the sum of their unit normals is its pseudonormal up
    // to a factor, and only the sign is used.
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
            // Against the outward normal is into its own solid; along it is into its own cavity.
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

/// Finds out where the other copies' triangles are, seen from each copy: beyond its surface or in
/// its solid. One triangle stands for all of a copy, as the sheets of two copies do not cross at
/// the point if the surface is sound there. Of very many copies each looks at kMostCompared, spread
/// over the others; where it so misses the one that matters, its move crosses and is put back.
void find_ways(const std::vector<std::uint32_t>& group, Mover& mover)
{
    constexpr std::size_t kMostCompared = 64;
    const TriangleMesh& mesh = mover.surface.mesh;
    const std::size_t stride = group.size() / kMostCompared + 1;
    const auto finds_within = [&](std::uint32_t v, std::uint32_t other) {
        const auto cone = mover.around.around(other);
        if (other == v || cone.size() == 0 || mover.around.around(v).size() == 0)
            return false;
        const Vec3I& t = mesh.triangles[*cone.begin()];
        const Vec3d middle =
            (Vec3d(mesh.points[t[0]]) + Vec3d(mesh.points[t[1]]) + Vec3d(mesh.points[t[2]])) / 3.0;
        const Vec3d direction = middle - Vec3d(mesh.points[v]);
        return direction.length() > 0 &&
               !points_outside(mesh, mover.around.around(v), v, mover.outward[v], direction);
    };
    for_each_index(group.size(), [&](std::size_t i) {
        bool within = false;
        // From the next one on, so that each copy looks at others of its own.
        for (std::size_t k = 1; k < group.size() && !within; k += stride)
            within = finds_within(group[i], group[(i + k) % group.size()]);
        if (within)
            mover.shrinks_void[group[i]] = 1;
    });
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
                // A triangle with a moved corner is no longer the input's bit for bit.
                surface.source[t] = kNoSource;
        }
}

} // namespace

void move_copies_apart(WorkingSurface& surface, RepairReport& report, Interrupter* interrupter)
{
    if (surface.copies.empty())
        return;
    const TriangleMesh& mesh = surface.mesh;
    Mover mover{surface, triangles_around_vertices(mesh.points.size(), mesh.triangles), mesh.points,
                pseudo_normals(mesh), std::vector<char>(mesh.points.size())};
    for (const std::vector<std::uint32_t>& group : surface.copies)
        find_ways(group, mover);
    std::vector<std::size_t> attempt(surface.copies.size(), 0);
    // One round more than there are attempts, so that groups which no attempt helped are put back
    // within the loop, and their neighbours are tested with them in place. A group that fails in
    // this last round only takes its next attempt untested; the check of the result would tell.
    for (std::size_t round = 0; round <= kAttempts.size(); ++round) {
        for (std::size_t g = 0; g < attempt.size(); ++g)
            mover.place(surface.copies[g], attempt[g]);
        const std::vector<char> crossing = crossing_triangles(mesh, interrupter);
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
