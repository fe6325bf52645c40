// SPDX-License-Identifier: Apache-2.0

// Takes pairs of free faces that should be apart, and where points are. Gives each point the
// half-spaces in which they are. What is apart is told by the shape at rest, where the faces are:
// the direction between them is turned as the tets behind them turn. Two faces that share an edge
// have void between them as long as the tet of their four corners is positive; a small void is such
// a tet itself, so its faces agree on what they want.

#include "pose/face_planes.h"

#include "growth/separation.h"
#include "mesh/most_visible.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace vdb_shell
{
namespace
{

using openvdb::Vec3d;
using openvdb::Vec3I;
using openvdb::Vec3s;
using Parts = RestShell::Parts;

/// Of the room that two faces have at rest, what they are to have on each side of the plane; no
/// more than so much of the spacing; and in roundings, at least.
constexpr double kShareOfRoomAtRest = 0.25, kMostRoom = 0.05, kLeastRoomInRoundings = 4;
constexpr double kInfinity = std::numeric_limits<double>::infinity();

Vec3d unit(Vec3d v)
{
    v.normalize(0.0);
    return v;
}

} // namespace

/// The points that two faces have in common.
struct FacePlanes::Common {
    std::array<std::uint32_t, 3> point{};
    int count = 0;
    bool has(std::uint32_t p) const
    {
        return std::find(point.begin(), point.begin() + count, p) != point.begin() + count;
    }
};

FacePlanes::FacePlanes(const Parts& parts, const PoseState& state, const std::vector<Vec3s>& skin)
    : parts_(parts), state_(state),
      lone_(std::max(parts.free.points.size(), parts.rest.size()) - parts.rest.size()),
      sides_(parts.rest.size())
{
    double farthest = 0;
    for (const Vec3s& p : skin)
        for (int k = 0; k < 3; ++k)
            farthest = std::max(farthest, std::abs(double(p[k])));
    rounding_ = farthest * double(std::numeric_limits<float>::epsilon());
    for (std::size_t t = 0; t < parts.free.outer_count; ++t)
        for (int k = 0; k < 3; ++k)
            if (const std::size_t p = parts.free.faces[t][k]; p >= parts.rest.size())
                lone_[p - parts.rest.size()] = Vec3d(skin[parts.stack.triangles()[t][k]]);
}

void FacePlanes::keep_apart(const std::vector<FacePair>& pairs)
{
    for (const FacePair& pair : pairs)
        at_rest_.try_emplace(pair, plane_at_rest(pair, common_of(pair)));
}

void FacePlanes::put()
{
    for (auto& list : sides_)
        list.clear();
    for (const auto& [pair, at_rest] : at_rest_) {
        const Common common = common_of(pair);
        if (common.count == 2) {
            put_wedge(pair, common);
            continue;
        }
        const Vec3d n = turned(pair, at_rest);
        common.count == 1 ? put_at_corner(pair, common, n, room_for(pair, at_rest))
                          : put_between(pair, n, room_for(pair, at_rest));
    }
}

FacePlanes::Common FacePlanes::common_of(const FacePair& pair) const
{
    const Vec3I &f = parts_.free.faces[pair[0]], &g = parts_.free.faces[pair[1]];
    Common common;
    for (int i = 0; i < 3; ++i)
        if (f[i] == g[0] || f[i] == g[1] || f[i] == g[2])
            common.point[std::size_t(common.count++)] = f[i];
    return common;
}

/// Across their closest points, or across a plane through the common corner that leaves the most
/// room on both sides. Of faces that share an edge nothing, for put_wedge() needs nothing.
FacePlanes::Plane FacePlanes::plane_at_rest(const FacePair& pair, const Common& common) const
{
    const Vec3I &f = parts_.free.faces[pair[0]], &g = parts_.free.faces[pair[1]];
    if (common.count > 1)
        return {};
    if (common.count == 0) {
        const growth::Corners first{rest(f[0]), rest(f[1]), rest(f[2])},
            second{rest(g[0]), rest(g[1]), rest(g[2])};
        const growth::SlabQuery query{&first, &second, kInfinity};
        growth::Slab slab;
        growth::slabs_between(&query, 1, &slab);
        return {-Vec3d(slab.n), std::max(0.0, slab.gap)};
    }
    std::vector<Vec3d> spokes, units;
    for (const auto& [face, sign] : {std::pair(f, -1.0), std::pair(g, 1.0)})
        for (int i = 0; i < 3; ++i)
            if (!common.has(face[i]))
                spokes.push_back(sign * (rest(face[i]) - rest(common.point[0])));
    for (const Vec3d& spoke : spokes)
        units.push_back(unit(spoke));
    const Vec3d across = most_visible(units);
    return {across, std::max(0.0, smallest_dot(spokes, across))};
}

Vec3d FacePlanes::turned(const FacePair& pair, const Plane& at_rest) const
{
    Vec3d n(0.0);
    for (const std::uint32_t f : pair)
        if (const std::uint32_t t = parts_.free.tet[f]; t != FreeFaces::kNoTet)
            n += unit(carried_normal(parts_, state_, t, at_rest.across));
    return unit(n);
}

double FacePlanes::share_of(double room, double spacing) const
{
    return std::max(kLeastRoomInRoundings * rounding_,
                    std::min(kShareOfRoomAtRest * room, kMostRoom * spacing));
}

double FacePlanes::room_for(const FacePair& pair, const Plane& at_rest) const
{
    double spacing = kInfinity;
    for (const std::uint32_t f : pair)
        for (int i = 0; i < 3; ++i)
            if (const std::uint32_t p = parts_.free.faces[f][i]; moves(p))
                spacing = std::min(spacing, parts_.spacing[p]);
    return share_of(at_rest.room, spacing);
}

void FacePlanes::push(std::uint32_t point, const Vec3d& towards, double by)
{
    if (moves(point))
        sides_[point].push_back({towards, towards.dot(now(point)) + by});
}

/// Each of the four corners has to stay above the plane of the others. Four heights are as many
/// times the volume, so a quarter of what is missing to each is about all of it.
void FacePlanes::put_wedge(const FacePair& pair, const Common& common)
{
    const Vec3I &f = parts_.free.faces[pair[0]], &g = parts_.free.faces[pair[1]];
    std::array<std::uint32_t, 4> corner{f[0], f[1], f[2], 0};
    for (int i = 0; i < 3; ++i)
        if (!common.has(g[i]))
            corner[3] = g[i];
    const auto volume = [&](std::uint32_t last) {
        return (rest(f[1]) - rest(f[0]))
            .cross(rest(f[2]) - rest(f[0]))
            .dot(rest(last) - rest(f[0]));
    };
    // Void is where the tet behind the first face is not.
    const openvdb::Vec4I& behind = parts_.all[parts_.free.tet[pair[0]]];
    for (int k = 0; k < 4; ++k)
        if (behind[k] != f[0] && behind[k] != f[1] && behind[k] != f[2] && volume(behind[k]) > 0)
            std::swap(corner[0], corner[1]);
    for (std::size_t k = 0; k < corner.size(); ++k) {
        const auto& [i, j, l] = kOtherCorners[k];
        const auto normal = [&, a = i, b = j, c = l](const auto& place) {
            return unit(
                (place(corner[b]) - place(corner[a])).cross(place(corner[c]) - place(corner[a])));
        };
        if (!moves(corner[k]))
            continue;
        const Vec3d at_rest = normal([this](std::uint32_t p) { return rest(p); });
        const Vec3d n = normal([this](std::uint32_t p) { return now(p); });
        const double height = std::abs(at_rest.dot(rest(corner[k]) - rest(corner[i])));
        const double missing =
            share_of(height, parts_.spacing[corner[k]]) - n.dot(now(corner[k]) - now(corner[i]));
        push(corner[k], n, missing / double(corner.size()));
    }
}

/// The plane goes through the common corner, which moves as well: half of it to each.
void FacePlanes::put_at_corner(const FacePair& pair, const Common& common, const Vec3d& n,
                               double room)
{
    const std::uint32_t apex = common.point[0];
    for (const auto& [face, towards] : {std::pair(pair[0], -n), std::pair(pair[1], n)})
        for (int i = 0; i < 3; ++i) {
            const std::uint32_t point = parts_.free.faces[face][i];
            if (common.has(point))
                continue;
            const double missing = room - towards.dot(now(point) - now(apex));
            push(point, towards, 0.5 * missing);
            push(apex, -towards, 0.5 * missing);
        }
}

/// Halfway between, or where it leaves what does not move the room.
void FacePlanes::put_between(const FacePair& pair, const Vec3d& n, double room)
{
    const Vec3I &f = parts_.free.faces[pair[0]], &g = parts_.free.faces[pair[1]];
    double first = -kInfinity, second = kInfinity, low = -kInfinity, high = kInfinity;
    for (int i = 0; i < 3; ++i) {
        first = std::max(first, n.dot(now(f[i])));
        second = std::min(second, n.dot(now(g[i])));
        if (!moves(f[i]))
            low = std::max(low, n.dot(now(f[i])) + room);
        if (!moves(g[i]))
            high = std::min(high, n.dot(now(g[i])) - room);
    }
    const double at = std::max(low, std::min(high, 0.5 * (first + second)));
    for (int i = 0; i < 3; ++i) {
        push(f[i], -n, n.dot(now(f[i])) + room - at);
        push(g[i], n, at + room - n.dot(now(g[i])));
    }
}

} // namespace vdb_shell
