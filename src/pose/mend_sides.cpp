// SPDX-License-Identifier: Apache-2.0

// Takes a pose whose inner points are where the skin carries them, or near. Leaves, for each side
// of the skin, a shell that passes the exact tests of growth: carried points are like those that
// growth prolongs from a coarser surface, nearly all right, and are mended in the same way. Pinned
// vertices stay pinned, for the tets have to stay the same.

#include "pose/mend_sides.h"

#include "growth/grow_state.h"
#include "growth/mend_prolonged.h"
#include "growth/prism.h"
#include "layers/columns.h"
#include "pose/improve_pose.h"
#include "pose/inflate_lost.h"
#include "pose/relax_pose.h"
#include "vdb_shell/shell/sides.h"

#include <algorithm>
#include <array>
#include <limits>
#include <utility>

namespace vdb_shell
{
namespace
{

using openvdb::Vec3d;
using openvdb::Vec3s;
using Parts = RestShell::Parts;
using growth::Connectivity;
using growth::GrowState;

std::vector<SkinSide> sides_of(const ShellStack& stack)
{
    std::vector<SkinSide> sides;
    if (stack.skin > 0)
        sides.push_back({0, true});
    if (stack.skin + 1 < stack.surfaces())
        sides.push_back({stack.surfaces() - 1, false});
    return sides;
}

/// Between the skin and the end of its pillars on that side, the points of the other surfaces.
void put_between(const Parts& parts, const SkinSide& side, const std::vector<Vec3s>& skin,
                 const std::vector<std::uint8_t>& valid, PoseState& state)
{
    const ShellStack& stack = parts.stack;
    const std::size_t first = std::min(side.end, stack.skin), last = std::max(side.end, stack.skin);
    for (std::size_t k = first + 1; k < last; ++k)
        for (std::size_t v = 0; v < skin.size(); ++v) {
            const std::uint32_t point = point_at(parts, k, v);
            const std::uint32_t end = point_at(parts, side.end, v);
            if (!valid[v] || point == Parts::kFree || end == Parts::kFree ||
                parts.skin_vertex[point] != Parts::kFree || point == end)
                continue;
            const Vec3d from(stack.surface(stack.skin)[v]), pillar = parts.rest[end] - from;
            const double share = (parts.rest[point] - from).length() / pillar.length();
            // How far the point was off its pillar: a rounding, and at rest it is right again.
            const Vec3d off = parts.rest[point] - (from + share * pillar);
            state.place[point] = Vec3d(skin[v]) + share * (state.place[end] - Vec3d(skin[v])) + off;
        }
}

bool same_splits(const ShellStack& stack, std::size_t first, std::size_t last)
{
    for (std::size_t k = first + 1; k < last; ++k)
        if (stack.splits[k].order != stack.splits[first].order)
            return false;
    return true;
}

/// Moves single points between the layers where rounding has turned a tet over, as cutting does
/// (layers/columns.h). Not where the layers were cut along other diagonals each.
void mend_between(const Parts& parts, const SkinSide& side, const std::vector<Vec3s>& skin,
                  PoseState& state, const StageProgress& progress)
{
    const ShellStack& stack = parts.stack;
    const std::size_t first = std::min(side.end, stack.skin), last = std::max(side.end, stack.skin);
    if (last - first < 2 || !same_splits(stack, first, last))
        return;
    Columns columns;
    columns.triangles = &stack.triangles();
    columns.upside_down = side.outside;
    columns.test = PrismTest::chosen_tets;
    columns.around = triangles_around_vertices(skin.size(), stack.triangles());
    columns.order = growth::order_indices(stack.splits[first].order);
    const std::size_t count = last - first;
    const auto point_of = [&](std::size_t j, std::size_t v) {
        return point_at(parts, side.outside ? stack.skin - j : stack.skin + j, v);
    };
    for (std::size_t j = 0; j <= count; ++j) {
        columns.surface.push_back(skin);
        columns.fixed.emplace_back(skin.size(), 1);
        for (std::size_t v = 0; v < skin.size(); ++v) {
            const std::uint32_t point = point_of(j, v);
            if (point == Parts::kFree || parts.skin_vertex[point] != Parts::kFree)
                continue;
            columns.surface[j][v] = Vec3s(state.place[point]);
            columns.fixed[j][v] = point == point_of(count, v);
        }
    }
    mend_columns(columns, progress);
    for (std::size_t j = 1; j < count; ++j)
        for (std::size_t v = 0; v < skin.size(); ++v)
            if (!columns.fixed[j][v])
                state.place[point_of(j, v)] = Vec3d(columns.surface[j][v]);
}

/// Growth's state with the inner points where they are carried. A cap of 0 keeps a vertex pinned.
GrowState state_of(const Parts& parts, const SkinSide& side, const Connectivity& connectivity,
                   const std::vector<Vec3s>& skin, const SkinCrossings& crossings,
                   const PoseState& state)
{
    std::vector<double> cap(skin.size(), 0.0);
    std::vector<Vec3d> ends(skin.begin(), skin.end());
    for (std::size_t v = 0; v < skin.size(); ++v) {
        const std::uint32_t point = point_at(parts, side.end, v);
        if (point == Parts::kFree || parts.skin_vertex[point] != Parts::kFree)
            continue;
        ends[v] = growth::rounded(state.place[point]);
        // Outward nothing else bounds a pillar.
        constexpr double kMostOfCarried = 2;
        cap[v] = side.outside ? kMostOfCarried * (ends[v] - Vec3d(skin[v])).length()
                              : std::numeric_limits<double>::infinity();
    }
    GrowState s = growth::make_state(connectivity, skin, cap);
    s.excused = crossings.region;
    if (parts.stack.layers.size() == 1 && !side.outside) {
        // The tets that there are, and no others: a fold of the skin leaves them more room.
        s.twelve = false;
        s.order = growth::order_indices(parts.stack.splits.front().order);
    }
    for (std::size_t v = 0; v < skin.size(); ++v) {
        s.b[v] = ends[v];
        s.pinned[v] = s.b[v] == s.a[v];
        s.trust_radius[v] = 0;
    }
    return s;
}

/// By point: the ends of lost pillars, and of those beside them.
std::vector<std::uint8_t> around_lost(const Parts& parts, const SkinSide& side, const GrowState& s)
{
    std::vector<std::uint8_t> around(parts.rest.size(), 0);
    const auto mark = [&](int v) {
        if (s.cap[std::size_t(v)] > 0)
            around[point_at(parts, side.end, std::size_t(v))] = 1;
    };
    for (const int v : lost_vertices(s)) {
        mark(v);
        for (const int u : growth::neighbours(*s.mesh, v))
            mark(u);
    }
    return around;
}

void mend_side(const Parts& parts, const SkinSide& side, const std::vector<Vec3s>& skin,
               const SkinCrossings& crossings, const PoseOptions& options, PoseState& state,
               PoseReport& report, const StageProgress& progress)
{
    TriangleMesh mesh{skin, parts.stack.triangles()};
    if (side.outside)
        mesh = reversed_surface(std::move(mesh));
    const Connectivity connectivity = growth::connect(skin.size(), mesh.triangles);
    GrowState s = state_of(parts, side, connectivity, skin, crossings, state);
    const std::vector<std::uint8_t> failed =
        growth::mend_placed(s, progress, growth::MendFrom::failures);
    report.lost_demanded += inflate_lost(s, mesh, progress);
    bring_back(parts, side, failed, s, state);
    std::vector<std::uint8_t> valid(skin.size(), 0);
    const std::size_t lost = lost_vertices(s).size();
    for (std::size_t v = 0; v < skin.size(); ++v) {
        valid[v] = s.cap[v] > 0 && !s.pinned[v];
        if (valid[v])
            state.place[point_at(parts, side.end, v)] = s.b[v];
    }
    improve_pose(parts, side, options, s, state, report, progress);
    if (lost > 0)
        relax_pose(parts, state, options.most_distortion, around_lost(parts, side, s), progress);
    report.lost_pillars += lost;
    put_between(parts, side, skin, valid, state);
    mend_between(parts, side, skin, state, progress);
}

} // namespace

bool can_mend_sides(const Parts& parts)
{
    return !parts.stack.tapered && parts.core.empty();
}

void mend_sides(const Parts& parts, PoseState& state, const std::vector<Vec3s>& skin,
                const SkinCrossings& crossings, const PoseOptions& options, PoseReport& report,
                const StageProgress& progress)
{
    for (const SkinSide& side : sides_of(parts.stack))
        mend_side(parts, side, skin, crossings, options, state, report, progress);
}

} // namespace vdb_shell
