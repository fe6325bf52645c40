// SPDX-License-Identifier: Apache-2.0
#include "growth/free_moves.h"

#include "core/parallel.h"
#include "growth/barrier.h"
#include "growth/diagonals.h"
#include "growth/pins.h"
#include "growth/sweep.h"

#include <tbb/enumerable_thread_specific.h>

#include <algorithm>

namespace vdb_shell::growth
{
namespace
{

constexpr double kEnoughFill = 0.998; ///< a solid this full is not worth another round
constexpr double kLeastSoftness = 1e-3;
constexpr double kSettled = 0.05;  ///< above it a loss is the barrier undoing jams
constexpr double kCoolFast = 0.3;  ///< factor per round where little is won
constexpr double kStale = 5e-4;    ///< share of the solid: a round that wins less is such a round
constexpr int kSweepsPerRound = 2; ///< between the same walls, but that they are recentred
/// Share of what makes a vertex worth asking in the next round that makes it so in the next sweep.
constexpr double kWorthAgain = 0.3;
constexpr int kHalvings = 5;
constexpr double kReachOfEdges = 3; ///< first reach over the shortest edge, nearly full
/// Share of the first reach that is worth its walls, nearly full: most vertices move less.
constexpr double kFirstReachNearlyFull = 0.45;
constexpr double kReachAhead = 1.1; ///< next reach over the last move
constexpr double kReachKept = 0.6;  ///< least share of a reach that is left for the next round
/// How far from a vertex walls steer it, as a share of its reach; the others only stop it.
constexpr double kSoftRange = 0.8;
constexpr float kWallWeight = 4; ///< of all near walls, where a tet has 1
// The barrier knows the cap as a ball a little wider, so that a vertex on the cap has room on every
// side; without it a vertex that only the cap holds would be sent far away, sideways as well.
constexpr double kBeyondCap = 1.02;

// Lengths as shares of the diagonal.
constexpr double kLeastMove = 1e-6;
constexpr double kQuietMove = 3e-5;
constexpr double kQuietShare = 3e-3; ///< of the pillar: a move that wins next to nothing
constexpr double kLeastReach = 1e-4, kMostReach = 0.05;

struct MoveRules {
    bool contacts;
    double softness; ///< barrier weight, in units of volume6
    double least;    ///< shorter moves are not worth making
};

/// Nearer than the reach, which the walls rely on.
Vec3d within_reach(const GrowState& s, int v, const Vec3d& x)
{
    const Vec3d off = x - s.home[v];
    const double distance = off.length(), most = 0.99 * s.reach[v];
    return distance > most ? s.home[v] + off * (most / distance) : x;
}

/// Adds the near walls, which together weigh no more than a few tets: there may be dozens, and most
/// say the same.
void wall_bounds(const GrowState& s, const Walls& w, int v, Bounds& bounds)
{
    const double range = kSoftRange * s.reach[v];
    const std::size_t first = bounds.size();
    all_walls_of(w, v, [&](const Wall& wall, double sign) {
        const double value = sign * wall.value(s.b[v]);
        if (value < range)
            bounds.add_unit(wall.n * static_cast<float>(sign), value);
        return true;
    });
    const auto count = static_cast<float>(bounds.size() - first);
    if (count > kWallWeight)
        bounds.weigh(first, kWallWeight / count);
}

bool propose_move(const GrowState& s, const Walls& w, int v, const MoveRules& rules, Bounds& bounds,
                  Vec3d& out)
{
    bounds.clear(s.b[v], s.reach[v]);
    tet_bounds(s, v, bounds);
    if (rules.contacts)
        wall_bounds(s, w, v, bounds);
    const Vec3d target =
        within_reach(s, v,
                     barrier_minimum(bounds, {s.a[v], kBeyondCap * s.cap[v]},
                                     inner_volume6_gradient(s, v), rules.softness));
    const Vec3d full = capped(s, v, target) - s.b[v];
    double share = 1;
    for (int i = 0; i < kHalvings && share * full.length() > rules.least; ++i, share *= 0.5) {
        out = capped(s, v, s.b[v] + share * full);
        if (move_allowed_between(s, w, v, out))
            return true;
    }
    return false;
}

/// Short where the inner surface has already collapsed: the walls stay few there. In a solid that
/// is nearly full it has collapsed in one direction at least.
double first_reach(const GrowState& s, int v, bool nearly_full)
{
    double outer = 0, longest = 0, shortest = kReachOfEdges * s.diagonal;
    for (const int u : neighbours(*s.mesh, v)) {
        const double inner = (s.b[u] - s.b[v]).length();
        outer += (s.a[u] - s.a[v]).length();
        longest = std::max(longest, inner);
        shortest = std::min(shortest, inner);
    }
    const int count = std::max(1, neighbours(*s.mesh, v).size());
    const double inner = nearly_full ? std::min(longest, kReachOfEdges * shortest) : longest;
    const double share = nearly_full ? kFirstReachNearlyFull : 1.0;
    return std::max(share * std::min(0.3 * outer / count, inner), 200 * s.rounding);
}

/// Hardly farther than the vertex went, for short reaches keep the walls few. The floor keeps the
/// rounding of a move within the hundredth that within_reach leaves.
void adapt_reach(GrowState& s, const std::vector<std::uint8_t>& still)
{
    const double least = std::max(kLeastReach * s.diagonal, 200 * s.rounding);
    for (int v = 0; v < s.mesh->vertices; ++v) {
        if (still[v])
            continue;
        const double ahead = kReachAhead * (s.b[v] - s.home[v]).length();
        s.reach[v] =
            std::max({least, kReachKept * s.reach[v], std::min(ahead, kMostReach * s.diagonal)});
    }
}

/// Rounds for which each vertex has not moved.
void update_quiet(const GrowState& s, std::vector<int>& quiet)
{
    for (int v = 0; v < s.mesh->vertices; ++v) {
        const double enough =
            std::max(kQuietMove * s.diagonal, kQuietShare * (s.b[v] - s.a[v]).length());
        quiet[v] = (s.b[v] - s.home[v]).length() < enough ? quiet[v] + 1 : 0;
    }
}

/// Pinned vertices, and those that have stopped moving but for every fourth round.
std::vector<std::uint8_t> find_still(const GrowState& s, const std::vector<int>& quiet)
{
    std::vector<std::uint8_t> still(quiet.size());
    for (std::size_t v = 0; v < still.size(); ++v)
        still[v] = s.pinned[v] || (quiet[v] > 1 && (quiet[v] + int(v)) % 4 != 0);
    return still;
}

/// What the vertices asked have won or given way since the walls were raised, as volume6, for one
/// that gives way is not done either; nought for the others.
void count_won(const GrowState& s, const std::vector<std::uint8_t>& still, std::vector<double>& won)
{
    won.resize(still.size());
    for_each_index(still.size(), [&](std::size_t i) {
        const int v = static_cast<int>(i);
        won[i] = still[i] ? 0 : std::abs(inner_volume6_gradient(s, v).dot(s.b[v] - s.home[v]));
    });
}

/// Adds to `still` those that have no more than `worth` (volume6) to win, nor any of their
/// neighbours.
void leave_out(const GrowState& s, const std::vector<double>& hope, double worth,
               std::vector<std::uint8_t>& still)
{
    for_each_index(still.size(), [&](std::size_t i) {
        const Slice<int> around = neighbours(*s.mesh, static_cast<int>(i));
        if (!(hope[i] > worth) &&
            std::none_of(around.begin(), around.end(), [&](int u) { return hope[u] > worth; }))
            still[i] = 1;
    });
}

/// Adds to `still` those that have won no more than `worth` since the walls were raised.
void let_rest(const GrowState& s, double worth, std::vector<std::uint8_t>& still)
{
    std::vector<double> won;
    count_won(s, still, won);
    for (std::size_t v = 0; v < still.size(); ++v)
        still[v] |= !(won[v] > worth);
}

/// Faster where little is left to give.
double cooled(double softness, double gain, double factor)
{
    const bool stale = softness < kSettled && std::abs(gain) < kStale;
    return std::max(kLeastSoftness, softness * (stale ? kCoolFast : factor));
}

/// What the barrier's weight is measured by: the solid, or where there is no end to what can be
/// filled, what the lines have filled.
double volume6_to_fill(const GrowState& s, double first_fill)
{
    const double enclosed = std::abs(volume6(s.a, s.mesh->faces));
    return s.bounded ? enclosed : enclosed * first_fill;
}

} // namespace

void move_freely(GrowState& s, const std::vector<double>& visibility, const GrowOptions& options,
                 const FreeStage& stage, const StageProgress& progress, GrowReport& report)
{
    const double first_fill = fill_of(s);
    const double per_tet =
        volume6_to_fill(s, first_fill) / (3.0 * std::max(1, s.mesh->face_count()));
    const std::vector<Vec3d> first_b = s.b;
    const std::vector<std::uint8_t> first_order = s.order, first_pinned = s.pinned;
    for (int v = 0; v < s.mesh->vertices; ++v)
        s.reach[v] = first_reach(s, v, s.bounded && first_fill > kNearlyFull);
    double fill = first_fill;
    // A barrier worth more than what is left to win would only undo what is reached.
    double softness = s.bounded ? std::min(stage.softness, std::max(kLeastSoftness, 7 * (1 - fill)))
                                : stage.softness;
    const double worth = stage.worth * std::abs(volume6(s.a, s.mesh->faces));
    std::vector<double> hope = stage.hope;
    Walls walls;
    std::vector<int> quiet(s.b.size(), 0);
    tbb::enumerable_thread_specific<Bounds> scratch;
    for (int round = 0; round < stage.rounds && !(s.bounded && fill >= kEnoughFill); ++round) {
        progress.stop_if_interrupted(100 * round / stage.rounds);
        const MoveRules rules{options.soft_contacts, per_tet * softness, kLeastMove * s.diagonal};
        // Seldom: a pin that cannot go now will hardly be able to in the next round.
        if ((round & (round - 1)) == 0)
            report.released += static_cast<std::size_t>(release_pins(s, visibility));
        std::vector<std::uint8_t> still = find_still(s, quiet);
        const bool choosy = worth > 0 && softness < kSettled;
        if (choosy && !hope.empty())
            leave_out(s, hope, worth, still);
        const std::ptrdiff_t asked = std::count(still.begin(), still.end(), 0);
        raise_walls(s, still, walls, softness < kSettled ? Tree::kept : Tree::anew);
        std::vector<std::uint8_t> resting = still;
        for (int i = 0; i < kSweepsPerRound; ++i) {
            if (i > 0)
                recentre_walls(s, walls);
            if (i > 0 && choosy)
                let_rest(s, kWorthAgain * worth, resting);
            sweep(s, walls, resting, [&](int v, Vec3d& x) {
                return propose_move(s, walls, v, rules, scratch.local(), x);
            });
        }
        if (worth > 0)
            count_won(s, still, hope);
        update_quiet(s, quiet);
        adapt_reach(s, still);
        if (options.flips && !s.twelve)
            report.flips += flip_for_room(s);
        ++report.rounds;
        const double gain = fill_of(s) - fill;
        fill += gain;
        if ((softness < stage.until && gain <= stage.until_gain * double(asked)) ||
            gain <= stage.enough * double(asked) ||
            (softness <= kLeastSoftness && gain < stage.least_gain))
            break;
        softness = cooled(softness, gain, stage.cool);
    }
    if (fill < first_fill) {
        s.b = first_b;
        s.order = first_order;
        s.pinned = first_pinned;
    }
}

} // namespace vdb_shell::growth
