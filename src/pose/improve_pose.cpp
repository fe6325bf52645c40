// SPDX-License-Identifier: Apache-2.0

// Takes a valid pose. Leaves a valid pose nearer to where the skin carries it and less distorted.
// First single points go back, one after another, each held against all triangles; then all points
// of a colour at a time take small steps between separating planes, as they do in growth.

#include "pose/improve_pose.h"

#include "core/parallel.h"
#include "growth/move_tests.h"
#include "growth/other_components.h"
#include "growth/separating_planes.h"
#include "growth/sweep.h"
#include "growth/trust_radius.h"
#include "growth/violations.h"

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
    s.inner_tree.refit([&](std::size_t i) {
        const int f = static_cast<int>(i);
        growth::Corners there = growth::inner_corners(s, f);
        FloatBox box = growth::float_box_of(there, s.rounding);
        for (int k = 0; k < 3; ++k)
            if (moves[s.mesh->corner(f, k)])
                there[k] = goal[s.mesh->corner(f, k)];
        box.add(growth::float_box_of(there, s.rounding));
        return box;
    });
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

/// Whether the vertex or a neighbour is marked.
bool beside(const GrowState& s, const std::vector<std::uint8_t>& marked, int v)
{
    const auto around = growth::neighbours(*s.mesh, v);
    return marked[v] ||
           std::any_of(around.begin(), around.end(), [&](int u) { return marked[u] != 0; });
}

/// Takes the largest share of the way that the tests allow; 0: none.
double go_back(GrowState& s, int v, const Vec3d& goal)
{
    for (double share = 1; share > kLeastShare; share *= 0.5)
        if (valid_at(s, v, growth::rounded(s.b[v] + share * (goal - s.b[v]))))
            return share;
    return 0;
}

/// Takes those that did not fail back at once, and then those of faces that fail by it away again,
/// until none does: at worst all are where they were, which is valid.
void bring_back_together(GrowState& s, const std::vector<int>& away, const std::vector<Vec3d>& goal,
                         const std::vector<std::uint8_t>& failed)
{
    const std::vector<Vec3d> mended = s.b;
    std::vector<std::uint8_t> moved(s.b.size(), 0);
    for (const int v : away)
        if (!failed[v]) {
            s.b[v] = goal[v];
            moved[v] = 1;
        }
    while (std::find(moved.begin(), moved.end(), 1) != moved.end()) {
        const std::vector<std::uint8_t> bad = growth::free_corners_of(
            s, growth::violating_faces(s, growth::faces_around(s, moved), false));
        for (std::size_t v = 0; v < moved.size(); ++v) {
            moved[v] = bad[v] && s.b[v] != mended[v];
            if (moved[v])
                s.b[v] = mended[v];
        }
    }
}

/// What all rounds share.
struct Improving {
    const Parts& parts;
    const SkinSide& side;
    double most_distortion;
};

/// By vertex, whether it stays: pinned, or near where it was carried to with nothing but sound tets
/// around it.
std::vector<std::uint8_t> at_rest(const Improving& job, const GrowState& s, const PoseState& state)
{
    const Parts& parts = job.parts;
    std::vector<std::uint8_t> sound(parts.all.size());
    for_each_index(sound.size(), [&](std::size_t t) {
        sound[t] = distortion(parts, state, t) <= job.most_distortion;
    });
    const auto all_sound = [&](std::uint32_t point) {
        return std::all_of(parts.incident.begin() + parts.first[point],
                           parts.incident.begin() + parts.first[point + 1],
                           [&](std::uint32_t t) { return sound[t] != 0; });
    };
    std::vector<std::uint8_t> stays(s.pinned.size());
    for_each_index(stays.size(), [&](std::size_t v) {
        const std::uint32_t point = point_at(parts, job.side.end, v);
        stays[v] = s.pinned[v] || (near_carried(parts, state, point) && all_sound(point));
    });
    return stays;
}

/// The same of a vertex alone, by the energy of its point.
bool rests(const Improving& job, const PoseState& state, std::size_t v)
{
    const std::uint32_t point = point_at(job.parts, job.side.end, v);
    return near_carried(job.parts, state, point) &&
           PointEnergy(job.parts, state, point, job.most_distortion).sound();
}

/// Sweeps of steps between the planes; gives back which vertices have moved.
std::vector<std::uint8_t> move_between(const growth::SeparatingPlanes& planes, const Improving& job,
                                       const std::vector<std::uint8_t>& inactive, GrowState& s,
                                       PoseState& state)
{
    std::vector<std::uint8_t> moved(inactive.size(), 0), asleep = inactive;
    for (int i = 0; i < kSweepsOfPass; ++i) {
        std::vector<std::uint8_t> now(inactive.size(), 0);
        growth::sweep(s, planes, asleep, [&](int v, Vec3d& x) {
            const std::uint32_t point = point_at(job.parts, job.side.end, std::size_t(v));
            const PointEnergy energy(job.parts, state, point, job.most_distortion);
            if ((energy.sound() && near_carried(job.parts, state, point)) ||
                !propose(s, planes, v, energy, x))
                return false;
            state.place[point] = x;
            now[v] = moved[v] = 1;
            return true;
        });
        // The others would be refused again.
        for_each_index(asleep.size(),
                       [&](std::size_t v) { asleep[v] = inactive[v] || !beside(s, now, int(v)); });
    }
    return moved;
}

} // namespace

void bring_back(const Parts& parts, const SkinSide& side, const std::vector<std::uint8_t>& failed,
                GrowState& s, const PoseState& state)
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
    bring_back_together(s, away, goal, failed);
    away.erase(std::remove_if(away.begin(), away.end(), [&](int v) { return s.b[v] == goal[v]; }),
               away.end());
    box_ways(s, away, goal);
    // One after another, as each changes what the next sees. What has failed is tried again where
    // a neighbour has moved since.
    std::vector<std::uint8_t> look(s.b.size(), 1);
    for (int pass = 0; pass < kPasses && !away.empty(); ++pass) {
        std::vector<int> left;
        for (const int v : away) {
            if (!look[v]) {
                left.push_back(v);
                continue;
            }
            look[v] = 0;
            const double share = go_back(s, v, goal[v]);
            if (share < 1)
                left.push_back(v);
            if (share > 0) {
                look[v] = 1;
                for (const int u : growth::neighbours(*s.mesh, v))
                    look[u] = 1;
            }
        }
        away = std::move(left);
    }
}

void improve_pose(const Parts& parts, const SkinSide& side, const PoseOptions& options,
                  GrowState& s, PoseState& state, PoseReport& report, const StageProgress& progress)
{
    const Improving job{parts, side, options.most_distortion};
    growth::SeparatingPlanes planes;
    std::vector<std::uint8_t> inactive = at_rest(job, s, state);
    for (int round = 0; round < options.rounds; ++round) {
        progress.stop_if_interrupted(100.0 * round / options.rounds);
        // What does not move needs no room.
        for (int v = 0; v < s.mesh->vertices; ++v)
            s.trust_radius[v] = inactive[v] ? 0 : kRadius * growth::mean_edge(*s.mesh, s.b, v);
        growth::separate_triangles(s, inactive, planes, growth::TreeUpdate::refit);
        const std::vector<std::uint8_t> moved = move_between(planes, job, inactive, s, state);
        ++report.rounds;
        if (std::find(moved.begin(), moved.end(), 1) == moved.end())
            break;
        for_each_index(inactive.size(), [&](std::size_t v) {
            inactive[v] = s.pinned[v] || !beside(s, moved, int(v)) || rests(job, state, v);
        });
    }
}

} // namespace vdb_shell
