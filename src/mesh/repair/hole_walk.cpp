// SPDX-License-Identifier: Apache-2.0
#include "mesh/repair/hole_walk.h"

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

std::uint32_t key_of(const EdgeUse& use)
{
    return 3 * use.triangle + use.side;
}

/// Direction of the triangle's third corner around the edge, counter-clockwise about the way from
/// the smaller to the larger point.
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

/// Around an edge of more than two sides: a backward one and the next forward one counter-clockwise
/// have solid between them.
void pair_around(const TriangleMesh& mesh, const EdgeUse* uses, std::size_t count,
                 std::vector<std::uint32_t>& partner)
{
    const std::vector<double> angles = angles_around(mesh, uses, count);
    std::vector<std::size_t> order(count);
    std::iota(order.begin(), order.end(), std::size_t(0));
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t a, std::size_t b) { return angles[a] < angles[b]; });
    for (std::size_t i = 0; i < count; ++i) {
        const EdgeUse &here = uses[order[i]], &next = uses[order[(i + 1) % count]];
        if (here.forward || !next.forward)
            continue;
        partner[key_of(here)] = key_of(next);
        partner[key_of(next)] = key_of(here);
    }
}

} // namespace

std::vector<std::uint32_t> pair_sides(const TriangleMesh& mesh)
{
    std::vector<std::uint32_t> partner(3 * mesh.triangles.size(), kUnpaired);
    const std::vector<EdgeUse> uses = sorted_edge_uses(mesh.triangles);
    for (std::size_t begin = 0, end = 0; begin < uses.size(); begin = end) {
        while (end < uses.size() && uses[end].edge == uses[begin].edge)
            ++end;
        if (end - begin > 2)
            pair_around(mesh, &uses[begin], end - begin, partner);
        // Two that run the same way have one side only: they are paired all the same, for there is
        // no hole between them.
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
    const auto next_corner = [](std::uint32_t side) { return side - side % 3 + (side + 1) % 3; };
    std::vector<std::uint32_t> parent(corners);
    std::iota(parent.begin(), parent.end(), 0U);
    const auto root_of = [&](std::uint32_t c) {
        while (parent[c] != c)
            c = parent[c] = parent[parent[c]];
        return c;
    };
    const auto join = [&](std::uint32_t a, std::uint32_t b) {
        a = root_of(a), b = root_of(b);
        parent[std::max(a, b)] = std::min(a, b);
    };
    for (std::uint32_t side = 0; side < corners; ++side) {
        const std::uint32_t other = partner[side];
        if (other == kUnpaired || other < side)
            continue;
        const bool opposite = point_of(side) == point_of(next_corner(other));
        join(side, opposite ? next_corner(other) : other);
        join(next_corner(side), opposite ? other : next_corner(other));
    }
    Fans fans{std::vector<std::uint32_t>(corners), {}, {}};
    for (std::uint32_t c = 0; c < corners; ++c) {
        if (root_of(c) == c) {
            fans.of_corner[c] = static_cast<std::uint32_t>(fans.point.size());
            fans.point.push_back(point_of(c));
            fans.open.push_back(0);
        }
        fans.of_corner[c] = fans.of_corner[root_of(c)];
    }
    for (std::uint32_t side = 0; side < corners; ++side)
        if (partner[side] == kUnpaired)
            fans.open[fans.of_corner[side]] = fans.open[fans.of_corner[next_corner(side)]] = 1;
    return fans;
}

std::vector<Hole> walk_holes(const TriangleMesh& mesh, const std::vector<std::uint32_t>& partner,
                             const Fans& fans)
{
    const auto corners = static_cast<std::uint32_t>(partner.size());
    const auto next_corner = [](std::uint32_t side) { return side - side % 3 + (side + 1) % 3; };
    // The hole runs through an unpaired side from its end to its start: it leaves the fan at the
    // side's end. Each open fan has one such side.
    std::vector<std::uint32_t> leaves(fans.point.size(), kUnpaired);
    std::vector<std::vector<std::uint32_t>> open_fans(mesh.points.size());
    for (std::uint32_t side = 0; side < corners; ++side) {
        if (partner[side] != kUnpaired)
            continue;
        const std::uint32_t fan = fans.of_corner[next_corner(side)];
        leaves[fan] = side;
        open_fans[fans.point[fan]].push_back(fan);
    }
    const auto following = [&](std::uint32_t side) {
        const std::uint32_t fan = fans.of_corner[side];
        const std::vector<std::uint32_t>& here = open_fans[fans.point[fan]];
        if (here.size() != 2)
            return leaves[fan];
        return leaves[here[0] == fan ? here[1] : here[0]];
    };
    std::vector<Hole> holes;
    std::vector<char> seen(corners);
    for (std::uint32_t start = 0; start < corners; ++start) {
        if (partner[start] != kUnpaired || seen[start])
            continue;
        Hole hole;
        for (std::uint32_t side = start; side != kUnpaired && !seen[side]; side = following(side)) {
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

} // namespace vdb_shell::repair
