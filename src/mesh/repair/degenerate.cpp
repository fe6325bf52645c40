// SPDX-License-Identifier: Apache-2.0
#include "mesh/repair/working_surface.h"

#include "core/exact.h"
#include "core/parallel.h"
#include "mesh/surface_defects.h"

#include <algorithm>
#include <map>

namespace vdb_shell::repair
{
namespace
{

using openvdb::Vec3d;
using openvdb::Vec3I;

/// Side k of a triangle runs from corner k to the next; the longest one, the first of equal ones.
int longest_side(const TriangleMesh& mesh, const Vec3I& t)
{
    int best = 0;
    double longest = -1;
    for (int k = 0; k < 3; ++k) {
        const double length =
            (Vec3d(mesh.points[t[(k + 1) % 3]]) - Vec3d(mesh.points[t[k]])).lengthSqr();
        if (length > longest) {
            longest = length;
            best = k;
        }
    }
    return best;
}

double smallest_height(const TriangleMesh& mesh, const Vec3I& t)
{
    const int k = longest_side(mesh, t);
    const Vec3d a(mesh.points[t[k]]), b(mesh.points[t[(k + 1) % 3]]),
        c(mesh.points[t[(k + 2) % 3]]);
    const double length = (b - a).length();
    return length > 0 ? (b - a).cross(c - a).length() / length : 0.0;
}

bool is_flat(const TriangleMesh& mesh, const Vec3I& t)
{
    return exact::collinear(mesh.points[t[0]], mesh.points[t[1]], mesh.points[t[2]]);
}

struct Use {
    std::uint32_t triangle;
    int side;
};

/// The single other triangle at side k of triangle t.
bool find_neighbour(const TriangleMesh& mesh, std::uint32_t t, int k, Use& found)
{
    const std::uint32_t a = mesh.triangles[t][k], b = mesh.triangles[t][(k + 1) % 3];
    int count = 0;
    for (std::uint32_t other = 0; other < mesh.triangles.size(); ++other) {
        const Vec3I& corner = mesh.triangles[other];
        for (int side = 0; side < 3 && other != t; ++side) {
            const std::uint32_t p = corner[side], q = corner[(side + 1) % 3];
            if ((p == a && q == b) || (p == b && q == a)) {
                found = {other, side};
                ++count;
            }
        }
    }
    return count == 1;
}

bool has_repeated_corner(const Vec3I& t)
{
    return t[0] == t[1] || t[1] == t[2] || t[2] == t[0];
}

/// A cap: its corner over the longest side cuts the neighbour there in two; one half takes the
/// triangle's place in the list.
void cut_neighbour(WorkingSurface& surface, std::uint32_t t, int side, const Use& neighbour)
{
    std::vector<Vec3I>& triangles = surface.mesh.triangles;
    const std::uint32_t middle = triangles[t][(side + 2) % 3];
    const Vec3I whole = triangles[neighbour.triangle];
    Vec3I first = whole, second = whole;
    first[(neighbour.side + 1) % 3] = middle;
    second[neighbour.side] = middle;
    triangles[neighbour.triangle] = first;
    triangles[t] = second;
    surface.source[neighbour.triangle] = surface.source[t] = kNoSource;
}

/// A needle: the two ends of its shortest side become one point, the one of smaller index.
void collapse(WorkingSurface& surface, std::uint32_t from, std::uint32_t to)
{
    std::vector<char> drop(surface.mesh.triangles.size());
    for (std::size_t t = 0; t < drop.size(); ++t) {
        Vec3I& corner = surface.mesh.triangles[t];
        for (int k = 0; k < 3; ++k) {
            if (corner[k] != from)
                continue;
            corner[k] = to;
            surface.source[t] = kNoSource;
        }
        drop[t] = has_repeated_corner(corner);
    }
    drop_triangles(surface, drop);
}

/// The shortest side's ends, if that side is shorter than `length`.
bool find_short_side(const TriangleMesh& mesh, const Vec3I& t, double length, Edge& ends)
{
    double shortest = length;
    bool found = false;
    for (int k = 0; k < 3; ++k) {
        const std::uint32_t a = t[k], b = t[(k + 1) % 3];
        const double side = (Vec3d(mesh.points[a]) - Vec3d(mesh.points[b])).length();
        if (side < shortest) {
            shortest = side;
            ends = {std::min(a, b), std::max(a, b)};
            found = true;
        }
    }
    return found;
}

/// Whether the two points have no common neighbours but the two across their edge: else a collapse
/// would fold the surface onto itself.
bool may_collapse(const TriangleMesh& mesh, const Edge& ends)
{
    std::map<std::uint32_t, int> seen; // bit 0: neighbour of the first end, bit 1: of the second
    std::size_t at_edge = 0;
    for (const Vec3I& t : mesh.triangles) {
        bool has[2] = {false, false};
        for (int k = 0; k < 3; ++k)
            for (std::size_t e = 0; e < 2; ++e)
                has[e] |= t[k] == ends[e];
        at_edge += has[0] && has[1];
        for (int k = 0; k < 3; ++k)
            seen[t[k]] |= (has[0] ? 1 : 0) | (has[1] ? 2 : 0);
    }
    std::size_t common = 0;
    for (const auto& [point, bits] : seen)
        common += bits == 3 && point != ends[0] && point != ends[1];
    return common == at_edge;
}

/// Removes one triangle that is flat or too low, and everything that follows from it.
void remove_one(WorkingSurface& surface, std::uint32_t t, double sliver_height,
                RepairReport& report)
{
    const TriangleMesh& mesh = surface.mesh;
    const bool flat = is_flat(mesh, mesh.triangles[t]);
    if (surface.source[t] != kNoSource)
        add_to(flat ? report.degenerate : report.slivers, surface.source[t]);
    Edge ends{};
    if (!flat && find_short_side(mesh, mesh.triangles[t], 2 * sliver_height, ends) &&
        may_collapse(mesh, ends)) {
        collapse(surface, ends[1], ends[0]);
        return;
    }
    const int side = longest_side(mesh, mesh.triangles[t]);
    Use neighbour{};
    if (find_neighbour(mesh, t, side, neighbour)) {
        if (surface.source[neighbour.triangle] != kNoSource)
            add_to(report.recut, surface.source[neighbour.triangle]);
        cut_neighbour(surface, t, side, neighbour);
        const std::uint32_t other = neighbour.triangle;
        std::vector<char> drop(mesh.triangles.size());
        drop[t] = has_repeated_corner(mesh.triangles[t]);
        drop[other] = has_repeated_corner(mesh.triangles[other]);
        if (drop[t] || drop[other])
            drop_triangles(surface, drop);
        return;
    }
    std::vector<char> drop(mesh.triangles.size());
    drop[t] = 1;
    drop_triangles(surface, drop);
}

} // namespace

void drop_degenerate(WorkingSurface& surface, double sliver_height, RepairReport& report)
{
    // Each removal may make its neighbour flat in turn; the bound ends rows of them that would cut
    // each other for ever.
    const std::size_t most = 4 * surface.mesh.triangles.size();
    for (std::size_t removed = 0; removed < most; ++removed) {
        const TriangleMesh& mesh = surface.mesh;
        std::vector<char> bad(mesh.triangles.size());
        for_each_index(bad.size(), [&](std::size_t t) {
            bad[t] =
                is_flat(mesh, mesh.triangles[t]) ||
                (sliver_height > 0 && smallest_height(mesh, mesh.triangles[t]) < sliver_height);
        });
        const auto first = std::find(bad.begin(), bad.end(), char(1));
        if (first == bad.end())
            return;
        remove_one(surface, static_cast<std::uint32_t>(first - bad.begin()), sliver_height, report);
    }
}

} // namespace vdb_shell::repair
