// SPDX-License-Identifier: Apache-2.0

// Takes oriented triangles that may meet by more than two at an edge and by several fans at a
// point, and leaves a manifold with open rims: each fan has a point of its own and each pair of
// sides an edge of its own. The copies stand in the same place until move_copies_apart(). Gueziec,
// Taubin, Lazarus and Horn 2001, "Cutting and stitching: converting sets of polygons to manifold
// surfaces", cut surfaces along singular edges in a like manner. The trap is fans that only a hole
// separates: they have to share their point, for the fill of the hole will join them.

#include "mesh/surface_defects.h"
#include "repair/hole_walk.h"
#include "repair/working_surface.h"

#include <algorithm>
#include <map>

namespace vdb_shell::repair
{
namespace
{

using openvdb::Vec3I;

/// Points that some rim passes twice. No fill is tried on such a rim, so the fans there are parted
/// even where they could be linked.
std::vector<char> pinched_points(const std::vector<Hole>& holes, std::size_t point_count)
{
    std::vector<char> pinched(point_count);
    std::vector<std::uint32_t> sorted;
    for (const Hole& hole : holes) {
        sorted = hole.points;
        std::sort(sorted.begin(), sorted.end());
        for (std::size_t i = 1; i < sorted.size(); ++i)
            pinched[sorted[i]] |= sorted[i] == sorted[i - 1];
    }
    return pinched;
}

/// Gives fans points of their own: the first at a point keeps it; open fans that are
/// linked share one, unless they are to stand `apart`.
void copy_points(WorkingSurface& surface, const Fans& fans,
                 const std::vector<std::uint32_t>& next_fan, const std::vector<char>& apart,
                 RepairReport& report)
{
    TriangleMesh& mesh = surface.mesh;
    const std::size_t points = mesh.points.size();
    std::vector<std::vector<std::uint32_t>> at_point(points);
    for (std::uint32_t fan = 0; fan < fans.point.size(); ++fan)
        at_point[fans.point[fan]].push_back(fan);
    std::vector<std::uint32_t> new_point = fans.point;
    for (std::uint32_t v = 0; v < points; ++v) {
        // The first fan keeps the point, so its triangles stay as they are, and the group begins
        // with the copy that may stay in its place. Copies are appended in the order of points and
        // fans.
        std::vector<std::uint32_t> group{v};
        bool kept = false;
        std::uint32_t open_point = kUnpaired;
        const bool share =
            !apart[v] && std::any_of(at_point[v].begin(), at_point[v].end(),
                                     [&](std::uint32_t fan) { return next_fan[fan] != fan; });
        for (const std::uint32_t fan : at_point[v]) {
            if (share && fans.open[fan] && open_point != kUnpaired) {
                new_point[fan] = open_point;
                continue;
            }
            if (kept) {
                new_point[fan] = static_cast<std::uint32_t>(mesh.points.size());
                mesh.points.push_back(openvdb::Vec3s(mesh.points[v]));
                group.push_back(new_point[fan]);
            }
            kept = true;
            if (share && fans.open[fan])
                open_point = new_point[fan];
        }
        if (group.size() == 1)
            continue;
        add_to(report.split_points, v);
        report.copies += group.size() - 1;
        surface.copies.push_back(std::move(group));
    }
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
        for (int corner = 0; corner < 3; ++corner)
            mesh.triangles[t][corner] = new_point[fans.of_corner[3 * t + std::size_t(corner)]];
}

/// Gives each pair of sides at an edge of several pairs a point of its own in the middle. A middle
/// is computed once for each edge, so its copies have equal bits. Returns how many such edges there
/// were; `middle_of` has the points by side.
std::size_t add_middles(WorkingSurface& surface, const std::vector<std::uint32_t>& partner,
                        std::vector<std::uint32_t>& middle_of, RepairReport& report)
{
    TriangleMesh& mesh = surface.mesh;
    const EdgeUses uses = sorted_edge_uses(mesh.triangles);
    std::size_t edges = 0;
    for (std::size_t begin = 0, end = 0; begin < uses.size(); begin = end) {
        while (end < uses.size() && uses[end].edge == uses[begin].edge)
            ++end;
        if (end - begin <= 2)
            continue;
        ++edges;
        const Edge& edge = uses[begin].edge;
        const openvdb::Vec3d middle =
            0.5 * (openvdb::Vec3d(mesh.points[edge[0]]) + openvdb::Vec3d(mesh.points[edge[1]]));
        std::vector<std::uint32_t> group;
        for (std::size_t i = begin; i < end; ++i) {
            const std::uint32_t side = 3 * uses[i].triangle + uses[i].side;
            if (middle_of[side] != kUnpaired)
                continue;
            const auto point = static_cast<std::uint32_t>(mesh.points.size());
            mesh.points.emplace_back(middle);
            group.push_back(point);
            middle_of[side] = point;
            // Both sides of a pair get the same middle, so the surface stays closed between them.
            if (partner[side] != kUnpaired)
                middle_of[partner[side]] = point;
        }
        report.copies += group.size();
        surface.copies.push_back(std::move(group));
    }
    return edges;
}

/// The triangle with the middles of its sides: a polygon of up to six corners. It starts at a
/// middle, if there is one, and so a fan from there has no flat triangle; from a corner the first
/// would be, if the next point is the middle of a side that begins there.
std::vector<std::uint32_t> polygon_of(const Vec3I& triangle, const std::uint32_t* middles)
{
    std::vector<std::uint32_t> ring;
    std::ptrdiff_t a_middle = 0;
    for (int side = 0; side < 3; ++side) {
        ring.push_back(triangle[side]);
        if (middles[side] == kUnpaired)
            continue;
        if (a_middle == 0)
            a_middle = std::ptrdiff_t(ring.size());
        ring.push_back(middles[side]);
    }
    std::rotate(ring.begin(), ring.begin() + a_middle, ring.end());
    return ring;
}

/// Parts edges that several pairs of sides have in use although all fans have their own points,
/// because both ends of the edge are one fan each.
void part_edges(WorkingSurface& surface, const std::vector<std::uint32_t>& partner,
                RepairReport& report)
{
    TriangleMesh& mesh = surface.mesh;
    std::vector<std::uint32_t> middle_of(partner.size(), kUnpaired);
    const std::size_t edges = add_middles(surface, partner, middle_of, report);
    const std::size_t triangles = mesh.triangles.size();
    for (std::size_t t = 0; t < triangles && edges > 0; ++t) {
        const std::vector<std::uint32_t> ring =
            polygon_of(mesh.triangles[t], middle_of.data() + 3 * t);
        if (ring.size() == 3)
            continue;
        mesh.triangles[t] = Vec3I(ring[0], ring[1], ring[2]);
        if (surface.source[t] != kNoSource)
            add_to(report.recut, surface.source[t]);
        surface.source[t] = kNoSource;
        for (std::size_t i = 3; i < ring.size(); ++i) {
            mesh.triangles.emplace_back(ring[0], ring[i - 1], ring[i]);
            surface.source.push_back(kNoSource);
        }
    }
}

std::size_t count_crowded(const TriangleMesh& mesh)
{
    const EdgeUses uses = sorted_edge_uses(mesh.triangles);
    std::size_t crowded = 0;
    for (std::size_t begin = 0, end = 0; begin < uses.size(); begin = end) {
        while (end < uses.size() && uses[end].edge == uses[begin].edge)
            ++end;
        crowded += end - begin > 2;
    }
    return crowded;
}

} // namespace

void part_fans(WorkingSurface& surface, RepairReport& report)
{
    // Counted before anything is parted, since most of these edges are parted by their points
    // already.
    report.split_edges += count_crowded(surface.mesh);
    const std::vector<std::uint32_t> partner = pair_sides(surface.mesh);
    const Fans fans = find_fans(surface.mesh, partner);
    const std::vector<std::uint32_t> next_fan = link_fans(surface.mesh, partner, fans);
    const std::vector<Hole> holes =
        walk_holes(surface.mesh, partner, fans, next_fan, one_sided_triangles(surface.mesh));
    copy_points(surface, fans, next_fan, pinched_points(holes, surface.mesh.points.size()), report);
    part_edges(surface, partner, report);
}

} // namespace vdb_shell::repair
