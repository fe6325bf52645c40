// SPDX-License-Identifier: Apache-2.0

// Takes a valid pose. Leaves a valid pose nearer to where the skin carries it and less distorted.
// First single points go back, one after another, each held against all triangles; then all points
// of a colour at a time take small steps between separating planes, as they do in growth.

#include "pose/improve_pose.h"

#include "core/parallel.h"
#include "growth/move_tests.h"
#include "growth/separating_planes.h"
#include "growth/sweep.h"
#include "growth/trust_radius.h"

#include <algorithm>
#include <utility>

namespace vdb_shell
{
namespace
{

using openvdb::Vec3d;
using Parts = RestShell::Parts;
using growth::GrowState;

/// How far a point may go in a round, in mean edges of the inner surface there. Five times as much
/// takes ten times as long, for there are more triangles to stay clear of (creature, rocker-arm).
constexpr double kRadius = 0.05;
/// Of what is left of the way back: the second pass finds what the first has made room for.
constexpr int kPasses = 4;
constexpr double kLeastShare = 0.1;
constexpr int kSweepsOfPass = 4, kStepHalvings = 6;
/// What a move has to leave of its energy at most.
constexpr double kLeastGain = 0.999;

/// Moves below that are not worth a look.
bool near_carried(const Parts& parts, const PoseState& state, std::uint32_t point)
{
    constexpr double kNearShare = 1e-3;
    return (state.place[point] - state.carried[point]).length() <=
           kNearShare * parts.spacing[point];
}

/// A step towards what the point wants that the exact tests allow.
bool propose(const GrowState& s, const growth::SeparatingPlanes& planes, int v,
             const PointEnergy& energy, Vec3d& out)
{
    Vec3d step;
    if (!energy.newton(step))
        return false;
    const double most = s.trust_radius[v] - (s.b[v] - s.trust_centre[v]).length();
    if (!(most > 0))
        return false;
    if (step.length() > most)
        step *= most / step.length();
    const double now = energy.at(Vec3d(0.0));
    for (int halving = 0; halving < kStepHalvings; ++halving, step *= 0.5) {
        out = growth::rounded(s.b[v] + step);
        if (energy.at(out - s.b[v]) < kLeastGain * now && growth::move_allowed(s, planes, v, out))
            return true;
    }
    return false;
}

/// Boxes that hold the inner triangles wherever these points may go on their way to `goal`.
void box_ways(GrowState& s, const std::vector<int>& points, const std::vector<Vec3d>& goal)
{
    std::vector<std::uint8_t> moves(s.b.size(), 0);
    for (const int v : points)
        moves[v] = 1;
    std::vector<FloatBox> boxes(s.mesh->faces.size());
    for_each_index(boxes.size(), [&](std::size_t i) {
        const int f = static_cast<int>(i);
        growth::Corners there = growth::inner_corners(s, f);
        boxes[i] = growth::float_box_of(there, s.rounding);
        for (int k = 0; k < 3; ++k)
            if (moves[s.mesh->corner(f, k)])
                there[k] = goal[s.mesh->corner(f, k)];
        boxes[i].add(growth::float_box_of(there, s.rounding));
    });
    s.inner_tree.refit(boxes);
}

bool valid_at(GrowState& s, int v, const Vec3d& x)
{
    if (x == s.a[v] || !growth::within_cap(s, v, x) || !growth::tets_positive_at(s, v, x) ||
        growth::swallows_component(s, v, x))
        return false;
    const Vec3d before = s.b[v];
    s.b[v] = x;
    for (const growth::FaceCorner& at : growth::star(*s.mesh, v))
        if (!growth::inner_triangle_clear(s, at.face)) {
            s.b[v] = before;
            return false;
        }
    return true;
}

} // namespace

void bring_back(const Parts& parts, const SkinSide& side, GrowState& s, const PoseState& state)
{
    std::vector<Vec3d> goal = s.b;
    std::vector<int> away;
    for (int v = 0; v < s.mesh->vertices; ++v) {
        if (s.pinned[v])
            continue;
        goal[v] = growth::rounded(state.carried[point_at(parts, side.end, std::size_t(v))]);
        if (goal[v] != s.b[v])
            away.push_back(v);
    }
    box_ways(s, away, goal);
    // One after another, as each changes what the next sees.
    for (int pass = 0; pass < kPasses && !away.empty(); ++pass) {
        std::vector<int> left;
        for (const int v : away) {
            bool there = false;
            for (double share = 1; !there && share > kLeastShare; share *= 0.5) {
                const Vec3d x = growth::rounded(s.b[v] + share * (goal[v] - s.b[v]));
                if (!valid_at(s, v, x))
                    continue;
                there = share == 1;
                break;
            }
            if (!there)
                left.push_back(v);
        }
        away = std::move(left);
    }
}

void improve_pose(const Parts& parts, const SkinSide& side, const PoseOptions& options,
                  GrowState& s, PoseState& state, PoseReport& report, const StageProgress& progress)
{
    growth::SeparatingPlanes planes;
    for (int v = 0; v < s.mesh->vertices; ++v) {
        const std::uint32_t point = point_at(parts, side.end, std::size_t(v));
        s.trust_radius[v] =
            point == Parts::kFree ? 0 : kRadius * growth::mean_edge(*s.mesh, s.b, v);
    }
    std::vector<std::uint8_t> inactive(s.pinned.size());
    for_each_index(inactive.size(), [&](std::size_t v) {
        const std::uint32_t point = point_at(parts, side.end, v);
        inactive[v] =
            s.pinned[v] || (near_carried(parts, state, point) &&
                            PointEnergy(parts, state, point, options.most_distortion).sound());
    });
    for (int round = 0; round < options.rounds; ++round) {
        progress.stop_if_interrupted(100 * round / options.rounds);
        growth::separate_triangles(s, inactive, planes);
        std::vector<std::uint8_t> moved(inactive.size(), 0);
        for (int i = 0; i < kSweepsOfPass; ++i)
            growth::sweep(s, planes, inactive, [&](int v, Vec3d& x) {
                const std::uint32_t point = point_at(parts, side.end, std::size_t(v));
                const PointEnergy energy(parts, state, point, options.most_distortion);
                if ((energy.sound() && near_carried(parts, state, point)) ||
                    !propose(s, planes, v, energy, x))
                    return false;
                state.place[point] = x;
                moved[v] = 1;
                return true;
            });
        ++report.rounds;
        bool any = false;
        for (int v = 0; v < s.mesh->vertices; ++v) {
            bool near = moved[v];
            for (const int u : growth::neighbours(*s.mesh, v))
                near = near || moved[u];
            inactive[v] = s.pinned[v] || !near;
            any = any || moved[v];
        }
        if (!any)
            break;
    }
}

} // namespace vdb_shell
