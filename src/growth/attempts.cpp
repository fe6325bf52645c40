// SPDX-License-Identifier: Apache-2.0

// Takes: what growth may set out from, and the user's options. Gives: what is tried, in turn. A
// table of the ways on two halves of machined parts is in docs/measurements/tried.md.

#include "growth/attempts.h"

#include <algorithm>

namespace vdb_shell::growth
{

namespace
{

/// What is begun from anything but the first start.
GrowOptions for_other_starts(GrowOptions options)
{
    if (options.method == Method::thickest) {
        // What has had twelve tets first is tried with three from the beginning.
        options.method = Method::certified;
        options.prism_test = PrismTest::chosen_tets;
    }
    return options;
}

/// The first way is the quick one, which most surfaces need alone. Where it has led into a corner,
/// the others take their time.
constexpr AttemptRounds kPatient{true};

/// What has so many triangles that it is given one round when it has come over coarser surfaces
/// cannot afford another start or a restart. Where it has no coarser ones, as the wrap of two thin
/// walls, each takes minutes (docs/measurements/tried.md, "Large surfaces without coarser ones").
bool affords_one(std::size_t triangles, const GrowOptions& options)
{
    return double(triangles) >= options.schedule.multilevel.one_round_triangles;
}

/// Only then may inner points leave their lines, as they do in all other ways.
bool may_leave_lines(const GrowOptions& options)
{
    return options.top_down && options.free_moves;
}

} // namespace

bool too_large_for_attempts(std::size_t triangles, const GrowOptions& options)
{
    return double(triangles) > options.schedule.multilevel.most_coarsest_triangles;
}

std::vector<Attempt> attempts_of(const GrowStart& start, std::size_t triangles,
                                 const GrowOptions& options)
{
    if (start.from == GrowFrom::shell)
        return {{GrowFrom::shell, {}, options}};
    const bool thickest = options.method == Method::thickest;
    const bool on_levels = start.from == GrowFrom::levels && !start.levels.empty();
    const LineStart first = options.top_down ? LineStart::shrunk : LineStart::thin;
    std::vector<Attempt> attempts{{on_levels ? GrowFrom::levels : GrowFrom::lines, first, options}};
    if ((on_levels && too_large_for_attempts(triangles, options)) ||
        affords_one(triangles, options))
        return attempts;
    const GrowOptions next = for_other_starts(options);
    if (may_leave_lines(options))
        for (const LineStart other : {LineStart::planar, LineStart::mended})
            attempts.push_back({GrowFrom::lines, other, next, kPatient});
    if (thickest && !on_levels)
        attempts.push_back({GrowFrom::lines, first, next});
    return attempts;
}

double enough_for(const Attempt& attempt)
{
    // Far below what levels leave of a rounded surface, for there another way takes its time. Who
    // asks for the thickest waits for half of what the others leave.
    constexpr double kNearlyFull = 0.99, kNearlyFullThickest = 0.995;
    const double from_lines =
        attempt.options.method == Method::thickest ? kNearlyFullThickest : kNearlyFull;
    const double full =
        attempt.from == GrowFrom::levels ? attempt.options.schedule.lines.nearly_full : from_lines;
    return std::min(full, attempt.options.schedule.barrier.enough_fill);
}

Restarts restarts_of(const Attempt& first, std::size_t triangles)
{
    const GrowthSchedule& schedule = first.options.schedule;
    Restarts restarts{{GrowFrom::shell, {}, for_other_starts(first.options), kPatient},
                      schedule.restarts.most,
                      enough_for(first)};
    GrowthSchedule& own = restarts.attempt.options.schedule;
    own.barrier.weight_decrease = schedule.restarts.weight_decrease;
    own.radius.factor_on_move = schedule.restarts.factor_on_move;
    own.radius.short_from_fill = 0;
    if (first.from == GrowFrom::shell || !may_leave_lines(first.options) ||
        affords_one(triangles, first.options))
        restarts.most = 0;
    if (first.from != GrowFrom::levels)
        return restarts;
    const bool large = too_large_for_attempts(triangles, first.options);
    restarts.enough =
        std::min(large ? schedule.restarts.large_enough : schedule.multilevel.wanted_fill,
                 schedule.barrier.enough_fill);
    return restarts;
}

} // namespace vdb_shell::growth
