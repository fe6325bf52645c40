// SPDX-License-Identifier: Apache-2.0

// Takes a valid state in which pillars are lost although directions for each of them were tried
// (pose/release_lost.h): in a fold several pillars have to move together. Their points are relaxed
// without the tests of growth, then put where their tets are positive; from there growth mends the
// contacts, as it does with points that are prolonged from a coarser surface.

#include "pose/restart_lost.h"

#include "growth/mend_prolonged.h"
#include "growth/pins.h"
#include "growth/prism.h"
#include "pose/relax_pose.h"

#include <array>
#include <utility>

namespace vdb_shell
{
namespace
{

using openvdb::Vec3d;
using Parts = RestShell::Parts;
using growth::GrowState;

/// Room that points leave themselves in their cells, in shares of their spacing, from attempt to
/// attempt: little is near to where they are carried, more leaves growth room for its own steps.
/// Three frames of the sample creature's walk that had up to four lost pillars each came out with
/// none after two or three attempts.
constexpr std::array<double, 9> kRoom{.002, .005, .01, .02, .04, .08, .15, .3, .5};

/// Where growth has the points, and the lost ones where they are in `carried`.
PoseState places_of(const Parts& parts, const SkinSide& side, const PoseState& carried,
                    const GrowState& s)
{
    PoseState state = carried;
    for (std::size_t v = 0; v < s.b.size(); ++v)
        if (s.cap[v] > 0 && !s.pinned[v])
            state.place[point_at(parts, side.end, v)] = s.b[v];
    return state;
}

} // namespace

std::size_t lost_pillars(const GrowState& s)
{
    std::size_t lost = 0;
    for (std::size_t v = 0; v < s.b.size(); ++v)
        lost += s.cap[v] > 0 && s.pinned[v];
    return lost;
}

std::vector<std::uint8_t> around_lost(const Parts& parts, const SkinSide& side, const GrowState& s)
{
    std::vector<std::uint8_t> around(parts.rest.size(), 0);
    const auto mark = [&](int v) {
        if (s.cap[std::size_t(v)] > 0)
            around[point_at(parts, side.end, std::size_t(v))] = 1;
    };
    for (int v = 0; v < s.mesh->vertices; ++v) {
        if (!s.pinned[std::size_t(v)] || !(s.cap[std::size_t(v)] > 0))
            continue;
        mark(v);
        for (const int u : growth::neighbours(*s.mesh, v))
            mark(u);
    }
    return around;
}

void restart_lost(const Parts& parts, const SkinSide& side, const PoseState& carried,
                  const InvertedTets& inverted, const PoseOptions& options, GrowState& s,
                  const StageProgress& progress)
{
    GrowState best = s;
    std::size_t fewest = lost_pillars(s);
    for (std::size_t attempt = 0; attempt < kRoom.size() && fewest > 0; ++attempt) {
        s = best;
        PoseState state = places_of(parts, side, carried, s);
        relax_pose(parts, state, options.most_distortion, around_lost(parts, side, s), progress);
        centre_points(parts, state, inverted, kRoom[attempt], progress);
        for (std::size_t v = 0; v < s.b.size(); ++v) {
            if (!(s.cap[v] > 0))
                continue;
            s.b[v] = growth::rounded(state.place[point_at(parts, side.end, v)]);
            s.pinned[v] = s.b[v] == s.a[v];
        }
        growth::mend_placed(s, progress);
        growth::release_pins(s, std::vector<double>(s.b.size(), 1.0),
                             growth::PillarsBesidePin::shortened);
        if (lost_pillars(s) < fewest) {
            fewest = lost_pillars(s);
            best = s;
        }
    }
    s = std::move(best);
}

} // namespace vdb_shell
