// SPDX-License-Identifier: Apache-2.0

// Takes points where the skin carries them. Leaves them there but for those around tets that are
// inverted or distorted, which find a compromise. Points of one colour have no tet in common and
// move at the same time. Contacts are nothing to it.

#include "pose/relax_pose.h"

#include "core/parallel.h"

#include <algorithm>

namespace vdb_shell
{
namespace
{

using openvdb::Vec3d;
using Parts = RestShell::Parts;

/// A point that moves by less, in units of its spacing, is at rest.
constexpr double kStill = 1e-3;
constexpr int kHalvingsOfStep = 8;
/// A round costs a hundredth of growth, and most points rest after a few.
constexpr int kRounds = 60;

/// Where the point goes; false where it stays.
bool moved(const Parts& parts, const PoseState& state, std::uint32_t point, double bound, Vec3d& to)
{
    const bool away = state.place[point] != state.carried[point];
    const PointEnergy energy(parts, state, point, bound);
    if (!away && energy.sound())
        return false;
    Vec3d step;
    if (!energy.newton(step))
        return false;
    const double now = energy.at(Vec3d(0.0));
    for (int halving = 0; halving < kHalvingsOfStep; ++halving, step *= 0.5)
        if (energy.at(step) < now) {
            to = state.place[point] + step;
            return step.length() > kStill * parts.spacing[point];
        }
    return false;
}

} // namespace

int relax_pose(const Parts& parts, PoseState& state, double most_distortion,
               const std::vector<std::uint8_t>& may_move, const StageProgress& progress)
{
    // A point is looked at again only if it, or one that it shares a tet with, has just moved.
    std::vector<std::uint8_t> awake = may_move, next(parts.rest.size());
    for (int round = 0; round < kRounds; ++round) {
        progress.stop_if_interrupted(100.0 * round / kRounds);
        std::fill(next.begin(), next.end(), std::uint8_t(0));
        bool any = false;
        for (const std::vector<std::uint32_t>& colour : parts.colour) {
            std::vector<std::uint8_t> has_moved(colour.size(), 0);
            for_each_index(colour.size(), [&](std::size_t i) {
                Vec3d to;
                if (awake[colour[i]] && moved(parts, state, colour[i], most_distortion, to)) {
                    state.place[colour[i]] = to;
                    has_moved[i] = 1;
                }
            });
            for (std::size_t i = 0; i < colour.size(); ++i) {
                if (!has_moved[i])
                    continue;
                any = true;
                for (std::uint32_t k = parts.first[colour[i]]; k < parts.first[colour[i] + 1]; ++k)
                    for (int c = 0; c < 4; ++c) {
                        // Points of later colours look at once, those of earlier ones next time.
                        const std::uint32_t other = parts.all[parts.incident[k]][c];
                        next[other] = may_move[other];
                        awake[other] = may_move[other];
                    }
            }
        }
        awake = next;
        if (!any)
            return round;
    }
    return kRounds;
}

} // namespace vdb_shell
