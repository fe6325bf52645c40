// SPDX-License-Identifier: Apache-2.0
#include "vdb_shell/growth/grow.h"
#include "vdb_shell/mesh/normals.h"

#include "core/parallel.h"
#include "core/stage_progress.h"
#include "growth/coarse_start.h"
#include "growth/diagonals.h"
#include "growth/free_moves.h"
#include "growth/improve_quality.h"
#include "growth/line_directions.h"
#include "growth/lines.h"
#include "growth/pins.h"
#include "growth/start.h"
#include "growth/stops.h"
#include "vdb_shell/resample/coarsen.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numeric>
#include <string>
#include <utility>

namespace vdb_shell
{
namespace
{

using growth::GrowState;
using openvdb::Vec3d;

// Rounds under the twelve-tet test before the three-tet ones: enough to spread the vertices.
constexpr int kTwelveRoundsFirst = 25;
// Of the solid. Below it, where the start had to be a thin one, free moves alone would get stuck;
// from there to kNearlyFull they do as well without lines.
constexpr double kThin = 0.3;
// What a round of lines has to win where free moves come after them.
constexpr double kLeastLineGain = 3e-3;
// Of the barrier's weight per round, and what the last rounds must win: half the rounds, and a
// fifth of a point of fill less, than what the thickest shell is given.
constexpr double kCool = 0.65, kCoolSlowly = 0.72;
constexpr double kLeastGain = 3e-4, kLeastGainThickest = 1e-4;
// About the triangles of the coarsest surface that growth begins on, and those of each over those
// of the next at most.
constexpr double kCoarsest = 1200, kMostCoarser = 9;
// The barrier's weight, and what a round wins for each vertex, share of the solid, at which growth
// ends on one and goes on on the next; how the weight falls on the coarsest and after it.
constexpr double kRoughUntil = 0.004, kRoughUntilGain = 1e-5;
constexpr double kRoughCoolFirst = 0.5, kRoughCool = 0.35;
// After it most is done: first weight over what is left to fill, and how it falls. Twice as much,
// and kCool, where there is time.
constexpr double kCarriedSoftness = 0.5, kCarriedCool = 0.4;
// What a vertex has to win in a round for it and its neighbours to be asked in the next, share of
// the solid: what asking is worth on a surface of so many vertices or more, less in proportion on a
// smaller one; from lines, all of them together. And what a round has to win for each vertex asked,
// as a share of that, for another to follow.
constexpr double kGainForVertex = 1e-6, kDear = 6500, kGainForAll = 3e-4;
constexpr double kGainForAsked = 0.46;
// Rounds of free moves at most; the triangles of a surface that gets one after a coarse start; and
// what the rounds on a coarser one may cost together, where one on the whole costs 1.
constexpr int kMostRounds = 40;
constexpr double kAffordable = 50000, kRoughCost = 1.0 / 3;
// Of the lengths to try first: a little less than where the fronts meet.
constexpr double kTopDown = 0.98;

/// How growth starts: from lines, or from the shell of a coarser surface, nearly done.
enum class Start { lines, carried };

/// Lines that growth only falls back on are not worth smoothing.
Directions prepare(const TriangleMesh& mesh, Directions directions, const GrowOptions& options,
                   Start start)
{
    if (options.mend_directions)
        growth::mend_directions(mesh, directions);
    if (options.smooth_directions && start == Start::lines)
        growth::smooth_directions(mesh, directions);
    return directions;
}

/// The longer of line stepping's length and half the ray to the other side, where two fronts would
/// meet: stop tests end many lines early, and how early depends on the voxels.
std::vector<double> first_lengths(const GrowState& s, const Directions& directions,
                                  const LineLengths& start)
{
    std::vector<double> lengths = growth::half_rays(s, directions);
    for (std::size_t v = 0; v < lengths.size(); ++v)
        lengths[v] = kTopDown * std::max(lengths[v], start.length[v]);
    return lengths;
}

std::ptrdiff_t pins(const GrowState& s)
{
    return std::count(s.pinned.begin(), s.pinned.end(), 1);
}

/// Top-down where the whole may collapse at once (sphere, torus), thin where that would pin more
/// vertices than the thin start does.
void settle(GrowState& s, const Directions& directions, const LineLengths& start,
            const GrowOptions& options, const StageProgress& progress)
{
    const std::vector<double> thin = growth::thin_heights(s);
    if (options.top_down) {
        growth::settle_start(s, directions, first_lengths(s, directions, start), progress);
        if (pins(s) == 0)
            return;
    }
    const std::vector<Vec3d> long_b = std::exchange(s.b, s.a);
    const std::vector<std::uint8_t> long_pinned = s.pinned;
    const std::ptrdiff_t long_pins = pins(s);
    growth::settle_start(s, directions, thin, progress);
    if (!options.top_down || pins(s) < long_pins)
        return;
    s.b = long_b;
    s.pinned = long_pinned;
}

struct Started {
    Start from = Start::lines;
    std::vector<double> hope; ///< carried: what each vertex may win back of what that cost, volume6
};

bool asks_for_more(const GrowOptions& options)
{
    return options.method == Method::thickest || options.free_rounds;
}

/// After a coarse start growth goes on only as long as that pays, unless more was asked for.
bool in_haste(Start start, const GrowOptions& options)
{
    return start == Start::carried && !asks_for_more(options);
}

double first_softness(const GrowState& s, Start start, bool hasty)
{
    return start == Start::carried ? (hasty ? 1 : 2) * kCarriedSoftness * (1 - growth::fill_of(s))
                                   : growth::kTwelveSoftness;
}

int affordable_rounds(std::size_t triangles)
{
    const double over = kAffordable / double(triangles);
    return static_cast<int>(std::min(double(kMostRounds), over * over));
}

/// Where no rounds on the whole surface follow, most of the time goes into what is mended, and
/// smoothing saves some of that; else rounds win back more than it saves.
growth::Bends bends_handed_on(std::size_t triangles)
{
    return affordable_rounds(triangles) > 0 ? growth::Bends::kept : growth::Bends::smoothed;
}

int most_rounds(const GrowState& s, Start start, const GrowOptions& options)
{
    return in_haste(start, options) ? affordable_rounds(s.mesh->faces.size())
                                    : options.free_rounds.value_or(kMostRounds);
}

/// On a coarser surface than that of so many triangles.
int most_rough_rounds(const GrowState& s, std::size_t triangles)
{
    const double cheap = kRoughCost * double(triangles) / s.mesh->face_count();
    return std::max(affordable_rounds(s.mesh->faces.size()),
                    static_cast<int>(std::min(double(kMostRounds), cheap)));
}

Directions rough_lines(const TriangleMesh& mesh, const GrowOptions& options, Start start)
{
    return prepare(mesh, directions_along(mesh, pseudo_normals(mesh)), options, start);
}

/// The levels' vertices as those of the mesh: by level.
std::vector<std::vector<std::uint32_t>> vertices_of(const std::vector<Coarsened>& levels)
{
    std::vector<std::vector<std::uint32_t>> from;
    for (const Coarsened& level : levels) {
        from.push_back(level.from);
        if (from.size() > 1)
            for (std::uint32_t& v : from.back())
                v = from[from.size() - 2][v];
    }
    return from;
}

template <class T>
std::vector<T> at_vertices(const std::vector<T>& all, const std::vector<std::uint32_t>& vertices)
{
    std::vector<T> some;
    some.reserve(vertices.size());
    for (const std::uint32_t v : vertices)
        some.push_back(all[v]);
    return some;
}

/// Inner points of the first level's shell, which growth has not finished, for a surface of so many
/// triangles.
std::vector<Vec3d> rough_inner(std::size_t triangles, const std::vector<Coarsened>& levels,
                               const LineLengths& start, const std::vector<double>& cap,
                               const GrowOptions& options, const StageProgress& progress)
{
    const auto from = vertices_of(levels);
    std::vector<Vec3d> inner;
    for (std::size_t level = levels.size(); level-- > 0;) {
        const TriangleMesh& mesh = levels[level].mesh;
        const Start from_what = inner.empty() ? Start::lines : Start::carried;
        const Directions lines = rough_lines(mesh, options, from_what);
        const growth::Connectivity connectivity =
            growth::connect(mesh.points.size(), mesh.triangles);
        GrowState s = growth::make_state(connectivity, mesh.points, at_vertices(cap, from[level]));
        if (from_what == Start::lines) {
            settle(s, lines, {at_vertices(start.length, from[level]), {}, {}}, options, progress);
        } else {
            const growth::Pillars pillars = growth::pillars_in(levels[level + 1].mesh, inner, mesh,
                                                               lines, bends_handed_on(triangles));
            growth::settle_carried(s, pillars.lines, pillars.length, progress);
        }
        GrowReport ignored;
        const int rounds = most_rough_rounds(s, triangles);
        growth::move_freely(s, lines.visibility, options,
                            {rounds, first_softness(s, from_what, true),
                             from_what == Start::carried ? kRoughCool : kRoughCoolFirst, kLeastGain,
                             kRoughUntil, kRoughUntilGain},
                            progress, ignored);
        inner = std::move(s.b);
    }
    return inner;
}

/// Sets the state to a shell that growth can go on from.
Started start_growth(GrowState& s, const TriangleMesh& mesh, const Directions& lines,
                     const LineLengths& start, const std::vector<Coarsened>& levels,
                     const GrowOptions& options, const StageProgress& progress)
{
    if (levels.empty()) {
        settle(s, lines, start, options, progress);
        return {};
    }
    const std::vector<Vec3d> inner =
        rough_inner(mesh.triangles.size(), levels, start, s.cap, options, progress);
    const growth::Pillars pillars = growth::pillars_in(levels.front().mesh, inner, mesh, lines,
                                                       bends_handed_on(mesh.triangles.size()));
    return {Start::carried, growth::settle_carried(s, pillars.lines, pillars.length, progress)};
}

bool worth_lengthening(const GrowState& s)
{
    const double fill = growth::fill_of(s);
    return !s.bounded || fill > growth::kNearlyFull || fill < kThin;
}

/// FreeStage::worth. Who asks for the most has everybody asked.
double worth_of_vertex(const GrowState& s, Start start, const GrowOptions& options)
{
    if (in_haste(start, options))
        return kGainForVertex * std::min(1.0, s.mesh->vertices / kDear);
    return asks_for_more(options) ? 0 : kGainForAll / s.mesh->vertices;
}

void move_off_the_lines(GrowState& s, const Directions& directions, const Started& started,
                        const GrowOptions& options, const StageProgress& progress,
                        GrowReport& report)
{
    const bool thickest = options.method == Method::thickest;
    const bool hasty = in_haste(started.from, options);
    const int rounds = most_rounds(s, started.from, options);
    const int twelve_rounds = thickest ? std::min(kTwelveRoundsFirst, rounds) : rounds;
    const double cool = thickest ? kCoolSlowly : hasty ? kCarriedCool : kCool;
    const double least_gain = thickest ? kLeastGainThickest : kLeastGain;
    const double worth = worth_of_vertex(s, started.from, options);
    const double enough = hasty ? kGainForAsked * worth : -1;
    growth::move_freely(s, directions.visibility, options,
                        {twelve_rounds, first_softness(s, started.from, hasty), cool, least_gain, 0,
                         0, enough, worth, started.hope},
                        progress, report);
    if (!thickest)
        return;
    s.twelve = false;
    growth::order_by_length(s);
    growth::move_freely(s, directions.visibility, options,
                        {rounds, growth::kThreeSoftness, cool, least_gain}, progress, report);
}

PrismShell shell_of(const TriangleMesh& mesh, const GrowState& s)
{
    PrismShell shell{mesh.points, mesh.points, mesh.triangles, {}};
    for (std::size_t v = 0; v < mesh.points.size(); ++v)
        if (!s.pinned[v])
            shell.inner[v] = openvdb::Vec3s(s.b[v]);
    return shell;
}

/// Under the twelve-tet test any rule of the user's will do; otherwise growth has its own orders.
bool may_turn_diagonals(const GrowState& s, const GrowOptions& options, const SplitOptions& split)
{
    return options.flips && (!s.twelve || split.rule == SplitRule::length_descending);
}

/// Settles the diagonals; gives back the ripples.
std::size_t choose_diagonals(GrowState& s, const PrismShell& shell, const GrowOptions& options,
                             const SplitOptions& split, GrowReport& report)
{
    PrismSplit by_rule;
    if (s.twelve) {
        by_rule = split_prisms(shell, split);
        for (std::size_t f = 0; f < by_rule.order.size(); ++f)
            s.order[f] = static_cast<std::uint8_t>(growth::order_index(by_rule.order[f]));
    }
    if (may_turn_diagonals(s, options, split))
        report.flips += growth::flip_for_quality(s);
    return by_rule.ripples;
}

void hold_to_quality(GrowState& s, const GrowOptions& options, const SplitOptions& split,
                     const StageProgress& progress, GrowReport& report)
{
    const growth::QualityResult raised = growth::raise_quality(
        s, options.min_quality, may_turn_diagonals(s, options, split), progress);
    report.quality_rounds = raised.rounds;
    report.flips += raised.flips;
    report.tets_below_quality = raised.tets_below;
    report.vertices_below_quality = raised.vertices_below;
}

PrismSplit split_of(const GrowState& s, std::size_t ripples)
{
    PrismSplit split;
    split.ripples = ripples;
    for (const std::uint8_t order : s.order)
        split.order.push_back(growth::tables().order[order]);
    return split;
}

bool worth_coarse_start(const TriangleMesh& mesh, const GrowOptions& options)
{
    return options.coarse_from > 0 && mesh.triangles.size() >= options.coarse_from &&
           options.top_down && options.free_moves && signed_volume(mesh.points, mesh.triangles) > 0;
}

} // namespace

std::vector<Coarsened> coarse_levels(const TriangleMesh& mesh, const GrowOptions& options)
{
    std::vector<Coarsened> levels;
    if (!worth_coarse_start(mesh, options))
        return levels;
    const auto finest = [&]() -> const TriangleMesh& {
        return levels.empty() ? mesh : levels.back().mesh;
    };
    const auto all = static_cast<double>(mesh.triangles.size());
    const double times = std::max(all / kCoarsest, kMostCoarser);
    const double steps = std::ceil(std::log(times) / std::log(kMostCoarser));
    const double coarser = std::pow(times, 1 / steps);
    for (int step = 0; step < steps; ++step) {
        const std::size_t count = finest().triangles.size();
        Coarsened coarse = coarsen(finest(), static_cast<std::size_t>(double(count) / coarser));
        if (coarse.mesh.triangles.size() > count / 2)
            break;
        levels.push_back(std::move(coarse));
    }
    return levels;
}

std::vector<std::uint32_t> vertices_of_coarsest(const TriangleMesh& mesh,
                                                const std::vector<Coarsened>& levels)
{
    if (!levels.empty())
        return vertices_of(levels).back();
    std::vector<std::uint32_t> all(mesh.points.size());
    std::iota(all.begin(), all.end(), 0U);
    return all;
}

GrowResult grow_shell(const TriangleMesh& mesh, const Directions& directions,
                      const LineLengths& start, const std::vector<double>& cap,
                      const GrowOptions& options, const SplitOptions& split,
                      Interrupter* interrupter, const GrowStart* from)
{
    const StageProgress progress(interrupter, "grow");
    if (options.free_rounds && *options.free_rounds < 0)
        throw InvalidOption("growth: free_rounds is " + std::to_string(*options.free_rounds) +
                            ", must not be negative");
    if (!(options.min_quality >= 0.0 && options.min_quality < 1.0))
        throw InvalidOption("growth: min_quality is " + std::to_string(options.min_quality) +
                            ", must be 0 or more and less than 1");
    assert(options.method != Method::raw);
    assert(directions.inward.size() == mesh.points.size());
    assert(start.length.size() == mesh.points.size() && cap.size() == mesh.points.size());
    const growth::Connectivity connectivity = growth::connect(mesh.points.size(), mesh.triangles);
    const std::vector<Coarsened> own_levels =
        from ? std::vector<Coarsened>() : coarse_levels(mesh, options);
    const std::vector<Coarsened>& levels = from ? from->levels : own_levels;
    Directions lines =
        prepare(mesh, directions, options, levels.empty() ? Start::lines : Start::carried);
    GrowState s = growth::make_state(connectivity, mesh.points, cap);
    GrowResult result;
    Started started;
    if (from && !from->inner.empty()) {
        const growth::Pillars pillars = growth::pillars_to(mesh, from->inner, std::move(lines));
        growth::settle_carried(s, pillars.lines, pillars.length, progress);
        lines = growth::pillars_to(mesh, shell_of(mesh, s).inner, pillars.lines).lines;
    } else {
        started = start_growth(s, mesh, lines, start, levels, options, progress);
    }
    result.report.released += static_cast<std::size_t>(growth::release_pins(s, lines.visibility));
    // A carried shell has left the lines.
    if (options.grow_lines && started.from == Start::lines &&
        (!options.free_moves || worth_lengthening(s)))
        growth::lengthen_lines(s, lines, options.free_moves && s.bounded ? kLeastLineGain : -1.0,
                               progress);
    result.report.fill_after_lines = growth::fill_of(s);
    if (options.free_moves)
        move_off_the_lines(s, lines, started, options, progress, result.report);
    std::size_t ripples = 0;
    std::vector<StopReason> stop;
    const auto choose = [&] {
        ripples = choose_diagonals(s, shell_of(mesh, s), options, split, result.report);
    };
    const auto probe = [&] { stop = growth::probe_stops(s); };
    if (s.twelve && !(options.min_quality > 0)) {
        // The stops do not depend on the diagonals then.
        run_together(choose, probe);
    } else {
        choose();
        if (options.min_quality > 0)
            hold_to_quality(s, options, split, progress, result.report);
        probe();
    }
    result.shell = shell_of(mesh, s);
    result.shell.stop = std::move(stop);
    result.split = split_of(s, ripples);
    return result;
}

} // namespace vdb_shell
