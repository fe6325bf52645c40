// SPDX-License-Identifier: Apache-2.0

// Takes triangles that may meet by threes and more at edges, and finds out what belongs together:
// which two sides are one edge, which corners are one fan, and how the rims of holes run from fan
// to fan. A side gets one partner at most, so surfaces that are parted by these answers are
// manifolds, whatever was paired. Angles are in doubles for that reason: they only decide which of
// several sheets go together, and a wrong choice gives another shape, but a manifold as well. A
// side is 3 * triangle + k, from corner k to the next, and a corner has the number of the side that
// starts there.

#include "repair/hole_walk.h"

#include "core/disjoint_sets.h"
#include "core/unit_vector.h"
#include "mesh/orientation.h"
#include "mesh/topology.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

namespace vdb_shell::repair
{
namespace
{

using openvdb::Vec3d;

std::uint32_t next_corner(std::uint32_t side)
{
    return side - side % 3 + (side + 1) % 3;
}

std::uint32_t key_of(const EdgeUse& use)
{
    return 3 * use.triangle + use.side;
}

/// Direction of each triangle's third corner around the edge, in radians, counter-clockwise about
/// the way from the smaller to the larger point. The first triangle is at 0. The axes x and y are
/// not of unit length but of equal length, which is all that an angle needs.
std::vector<double> angles_around(const TriangleMesh& mesh, const EdgeUse* uses, std::size_t count)
{
    const Vec3d origin(mesh.points[uses[0].edge[0]]);
    const Vec3d axis = (Vec3d(mesh.points[uses[0].edge[1]]) - origin).unit();
    std::vector<double> angles(count);
    Vec3d x(0.0), y(0.0);
    for (std::size_t i = 0; i < count; ++i) {
        const std::uint32_t third = mesh.triangles[uses[i].triangle][(uses[i].side + 2) % 3];
        const Vec3d to_third = Vec3d(mesh.points[third]) - origin;
        const Vec3d across = to_third - axis * to_third.dot(axis);
        if (i == 0) {
            x = across;
            y = axis.cross(across);
        }
        angles[i] = std::atan2(across.dot(y), across.dot(x));
    }
    return angles;
}

/// Pairs the sides around an edge of more than two. The normal of a side that runs forward, from
/// the smaller to the larger point, shows counter-clockwise around the edge, so its solid lies
/// clockwise of it; with a backward side it is the other way round. So a backward side and the next
/// forward one counter-clockwise have solid between them.
void pair_around(const TriangleMesh& mesh, const EdgeUse* uses, std::size_t count,
                 std::vector<std::uint32_t>& partner)
{
    const std::vector<double> angles = angles_around(mesh, uses, count);
    std::vector<std::size_t> order(count);
    std::iota(order.begin(), order.end(), std::size_t(0));
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t a, std::size_t b) { return angles[a] < angles[b]; });
    // Wedges within wedges pair like brackets, and which bracket closes which does not depend on
    // where one begins to read, as long as one reads round twice. What is left at last is open. The
    // sort is stable, so equal angles keep the order of their triangles.
    std::vector<std::size_t> open;
    for (std::size_t i = 0; i < 2 * count; ++i) {
        const EdgeUse& here = uses[order[i % count]];
        if (partner[key_of(here)] != kUnpaired)
            continue;
        if (!here.forward) {
            if (i < count)
                open.push_back(order[i]);
            continue;
        }
        if (open.empty())
            continue;
        partner[key_of(here)] = key_of(uses[open.back()]);
        partner[key_of(uses[open.back()])] = key_of(here);
        open.pop_back();
    }
}

} // namespace

std::vector<std::uint32_t> pair_sides(const TriangleMesh& mesh)
{
    std::vector<std::uint32_t> partner(3 * mesh.triangles.size(), kUnpaired);
    const EdgeUses uses = sorted_edge_uses(mesh.triangles);
    for (std::size_t begin = 0, end = 0; begin < uses.size(); begin = end) {
        while (end < uses.size() && uses[end].edge == uses[begin].edge)
            ++end;
        if (end - begin > 2)
            pair_around(mesh, &uses[begin], end - begin, partner);
        // Two sides that run the same way are left only in a piece that has no orientation. They
        // are paired all the same, because there is no hole between them.
        if (end - begin == 2) {
            partner[key_of(uses[begin])] = key_of(uses[begin + 1]);
            partner[key_of(uses[begin + 1])] = key_of(uses[begin]);
        }
    }
    return partner;
}

Fans find_fans(const TriangleMesh& mesh, const std::vector<std::uint32_t>& partner)
{
    const std::size_t corners = 3 * mesh.triangles.size();
    const auto point_of = [&](std::uint32_t corner) {
        return mesh.triangles[corner / 3][int(corner % 3)];
    };
    // The root of a fan is its first corner, and fans are numbered by that below.
    DisjointSets sets(corners);
    for (std::uint32_t side = 0; side < corners; ++side) {
        const std::uint32_t other = partner[side];
        if (other == kUnpaired || other < side)
            continue;
        // In a consistent orientation the partner runs the other way, and its first corner is at
        // this side's second point. In a one-sided piece it may run the same way.
        const bool opposite = point_of(side) == point_of(next_corner(other));
        sets.join(side, opposite ? next_corner(other) : other);
        sets.join(next_corner(side), opposite ? other : next_corner(other));
    }
    Fans fans{std::vector<std::uint32_t>(corners), {}, {}};
    for (std::uint32_t c = 0; c < corners; ++c) {
        if (sets.root_of(c) == c) {
            fans.of_corner[c] = static_cast<std::uint32_t>(fans.point.size());
            fans.point.push_back(point_of(c));
            fans.open.push_back(0);
        }
        fans.of_corner[c] = fans.of_corner[sets.root_of(c)];
    }
    for (std::uint32_t side = 0; side < corners; ++side)
        if (partner[side] == kUnpaired)
            fans.open[fans.of_corner[side]] = fans.open[fans.of_corner[next_corner(side)]] = 1;
    return fans;
}

namespace
{

/// An open fan is a strip around its point with two ends: one unpaired side ends at the point,
/// another one starts there. A hole runs against the triangles, so it leaves the point by the
/// former and comes to it by the latter. Where a one-sided piece makes both ends alike, one of them
/// stays unpaired here.
struct Border {
    std::vector<std::uint32_t> leaves, comes;
    std::vector<std::vector<std::uint32_t>> open_fans; ///< by point
};

Border border_of(const TriangleMesh& mesh, const std::vector<std::uint32_t>& partner,
                 const Fans& fans)
{
    Border border{std::vector<std::uint32_t>(fans.point.size(), kUnpaired),
                  std::vector<std::uint32_t>(fans.point.size(), kUnpaired),
                  std::vector<std::vector<std::uint32_t>>(mesh.points.size())};
    for (std::uint32_t side = 0; side < partner.size(); ++side) {
        if (partner[side] != kUnpaired)
            continue;
        const std::uint32_t fan = fans.of_corner[next_corner(side)];
        border.leaves[fan] = side;
        border.comes[fans.of_corner[side]] = side;
        border.open_fans[fans.point[fan]].push_back(fan);
    }
    return border;
}

/// Angles of the points around `centre`, seen against the sum of the normals of the triangles
/// there. Their sum is weighted by area and not of unit length, so that the angles are distorted;
/// only their cyclic order is used, and that stays.
class View
{
public:
    View(const TriangleMesh& mesh, const Vec3d& centre, const Vec3d& normal)
        : mesh_(mesh), centre_(centre)
    {
        x_ = unit_vector(at_right_angles_to(normal));
        y_ = unit_vector(normal).cross(x_);
    }
    double angle(std::uint32_t point) const
    {
        const Vec3d to = Vec3d(mesh_.points[point]) - centre_;
        return std::atan2(to.dot(y_), to.dot(x_));
    }

private:
    const TriangleMesh& mesh_;
    Vec3d centre_, x_, y_;
};

/// At a point of three or more open fans a hole that comes to one goes on to the fan that is next
/// clockwise, seen from outside: the hole is the gap between these two. Nothing is returned when
/// this is no one-to-one order, as can be around a point whose triangles are folded over each
/// other; the rims then run through each fan by itself.
std::vector<std::uint32_t> next_clockwise(const TriangleMesh& mesh, const Border& border,
                                          const std::vector<std::uint32_t>& here, const View& view)
{
    const auto corner = [&](std::uint32_t key) { return mesh.triangles[key / 3][int(key % 3)]; };
    // Sides that leave the point, by their angles; of equal ones the first stands last, where the
    // search from above comes to it first.
    std::vector<std::pair<double, std::size_t>> leaving;
    for (std::size_t i = 0; i < here.size(); ++i)
        leaving.emplace_back(view.angle(corner(border.leaves[here[i]])), here.size() - i);
    std::sort(leaving.begin(), leaving.end());
    std::vector<std::uint32_t> next;
    for (const std::uint32_t fan : here) {
        const double from = view.angle(corner(next_corner(border.comes[fan])));
        const auto above =
            std::upper_bound(leaving.begin(), leaving.end(), std::make_pair(from, here.size()));
        const auto& nearest = above == leaving.begin() ? leaving.back() : *(above - 1);
        next.push_back(here[here.size() - nearest.second]);
    }
    std::vector<std::uint32_t> sorted = next;
    std::sort(sorted.begin(), sorted.end());
    return std::adjacent_find(sorted.begin(), sorted.end()) == sorted.end()
               ? next
               : std::vector<std::uint32_t>();
}

} // namespace

std::vector<std::uint32_t> link_fans(const TriangleMesh& mesh,
                                     const std::vector<std::uint32_t>& partner, const Fans& fans)
{
    const Border border = border_of(mesh, partner, fans);
    std::vector<Vec3d> normals(mesh.points.size(), Vec3d(0.0));
    for (const openvdb::Vec3I& t : mesh.triangles) {
        const Vec3d a(mesh.points[t[0]]);
        const Vec3d normal = (Vec3d(mesh.points[t[1]]) - a).cross(Vec3d(mesh.points[t[2]]) - a);
        for (int k = 0; k < 3; ++k)
            normals[t[k]] += normal;
    }
    std::vector<std::uint32_t> next_fan(fans.point.size());
    std::iota(next_fan.begin(), next_fan.end(), 0U);
    for (std::size_t v = 0; v < mesh.points.size(); ++v) {
        const std::vector<std::uint32_t>& here = border.open_fans[v];
        const bool whole = std::all_of(here.begin(), here.end(), [&](std::uint32_t fan) {
            return border.comes[fan] != kUnpaired && border.leaves[fan] != kUnpaired;
        });
        if (here.size() < 2 || !whole)
            continue;
        // Two open fans can be linked in one way only, and no angle has to be taken.
        std::vector<std::uint32_t> next{here[1], here[0]};
        if (here.size() > 2)
            next =
                next_clockwise(mesh, border, here, View(mesh, Vec3d(mesh.points[v]), normals[v]));
        for (std::size_t i = 0; i < next.size(); ++i)
            next_fan[here[i]] = next[i];
    }
    return next_fan;
}

std::vector<Hole> walk_holes(const TriangleMesh& mesh, const std::vector<std::uint32_t>& partner,
                             const Fans& fans, const std::vector<std::uint32_t>& next_fan,
                             const std::vector<char>& skipped)
{
    const std::vector<std::uint32_t> leaves = border_of(mesh, partner, fans).leaves;
    std::vector<Hole> holes;
    std::vector<char> seen(partner.size());
    for (std::uint32_t start = 0; start < partner.size(); ++start) {
        if (partner[start] != kUnpaired || seen[start] || skipped[start / 3])
            continue;
        Hole hole;
        // Links are one to one at each point, so a walk comes back to its start. The mark on each
        // side also ends walks where sides of one-sided pieces lead into each other.
        for (std::uint32_t side = start; side != kUnpaired && !seen[side];
             side = leaves[next_fan[fans.of_corner[side]]]) {
            seen[side] = 1;
            const openvdb::Vec3I& t = mesh.triangles[side / 3];
            hole.points.push_back(t[int((side + 1) % 3)]);
            hole.beyond.push_back(t[int((side + 2) % 3)]);
            hole.triangles.push_back(side / 3);
        }
        holes.push_back(std::move(hole));
    }
    return holes;
}

std::vector<char> one_sided_triangles(const TriangleMesh& mesh)
{
    const Orientation orientation =
        consistent_orientation(sorted_edge_uses(mesh.triangles), mesh.triangles.size());
    std::vector<char> one_sided(mesh.triangles.size());
    for (std::size_t t = 0; t < one_sided.size(); ++t)
        one_sided[t] = orientation.one_sided[orientation.piece_of[t]];
    return one_sided;
}

} // namespace vdb_shell::repair
