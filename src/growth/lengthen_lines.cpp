// SPDX-License-Identifier: Apache-2.0

// Takes: a valid shell along lines. Leaves: a valid shell along the same lines, longer. Worth its
// time where the start is thin, for free moves alone get stuck there, and where it is nearly full,
// which lines finish sooner. Source: docs/theory.md, "Growth".

#include "growth/lengthen_lines.h"

#include "growth/active_set.h"
#include "growth/sweep.h"

#include <algorithm>
#include <limits>

namespace vdb_shell::growth
{
namespace
{

struct Steps {
    std::vector<double> length, step;
};

bool may_grow(const GrowState& s, const Steps& steps, int v)
{
    return !s.pinned[v] && steps.step[v] >= s.schedule.lines.shortest_step * s.diagonal &&
           steps.length[v] < s.cap[v];
}

/// The share of the way from b to x at which the first separating plane is met; may be over 1.
double share_up_to_planes(const SeparatingPlanes& planes, int v, const Vec3d& b, const Vec3d& x)
{
    // Any value above 1 over share_of_room would do: the whole step is free then.
    double share = 2;
    all_planes_of(planes, v, [&](const SeparatingPlane& plane, double sign) {
        const double here = sign * plane.value(b), there = sign * plane.value(x);
        if (there < here)
            share = std::min(share, here / (here - there));
        return true;
    });
    return share;
}

/// A step along the line, or as much of it as the planes leave room for.
bool propose_longer(const GrowState& s, const SeparatingPlanes& planes, const Steps& steps,
                    const Directions& d, int v, Vec3d& x)
{
    const double length = steps.length[v], step = std::min(steps.step[v], s.cap[v] - length);
    x = end_within_cap(s, v, d.inward[v], length + step);
    const double share = s.schedule.lines.share_of_room * share_up_to_planes(planes, v, s.b[v], x);
    if (share < 1)
        x = end_within_cap(s, v, d.inward[v], length + share * step);
    return move_allowed(s, planes, v, x);
}

/// Notes how far each vertex came; returns how many may grow further.
int update_steps(const GrowState& s, Steps& steps)
{
    int growing = 0;
    // The step follows the room that a vertex has, which no one step length for all would, as edges
    // of one mesh differ much in length.
    for (int v = 0; v < s.mesh->vertices; ++v) {
        if (!may_grow(s, steps, v))
            continue;
        const double length = (s.b[v] - s.a[v]).length(), gain = length - steps.length[v];
        steps.length[v] = length;
        steps.step[v] =
            gain > 0.5 * steps.step[v]
                ? std::min(2 * steps.step[v], s.schedule.lines.longest_step * s.diagonal)
                : 0.5 * steps.step[v];
        growing += may_grow(s, steps, v);
    }
    return growing;
}

Steps first_steps(const GrowState& s)
{
    Steps steps{std::vector<double>(s.b.size()),
                std::vector<double>(s.b.size(), s.schedule.lines.first_step * s.diagonal)};
    for (int v = 0; v < s.mesh->vertices; ++v)
        steps.length[v] = (s.b[v] - s.a[v]).length();
    return steps;
}

/// Makes the next step of each vertex its trust radius; marks those that take none.
void set_radii(GrowState& s, const Steps& steps, std::vector<std::uint8_t>& inactive)
{
    for (int v = 0; v < s.mesh->vertices; ++v)
        inactive[v] = !may_grow(s, steps, v);
    leave_out_crowds(s, inactive);
    for (int v = 0; v < s.mesh->vertices; ++v)
        s.trust_radius[v] = inactive[v] ? 0 : (1 + kRadiusMargin) * steps.step[v] + s.rounding;
}

} // namespace

void lengthen_lines(GrowState& s, const Directions& directions, const EndOfLines& end,
                    const StageProgress& progress)
{
    Steps steps = first_steps(s);
    SeparatingPlanes planes;
    std::vector<std::uint8_t> inactive(s.b.size());
    int growing = s.mesh->vertices;
    double fill = fill_of(s);
    const int most_rounds = s.schedule.lines.most_rounds;
    for (int round = 0; growing > 0 && fill < end.enough_fill && round < most_rounds; ++round) {
        progress.stop_if_interrupted(0);
        set_radii(s, steps, inactive);
        separate_triangles(s, inactive, planes);
        sweep(s, planes, inactive,
              [&](int v, Vec3d& x) { return propose_longer(s, planes, steps, directions, v, x); });
        // One sweep a round: along a line the first one takes all the room that the planes leave.
        growing = update_steps(s, steps);
        const double gain = fill_of(s) - fill;
        fill += gain;
        // In the first rounds steps are too short to win much, whatever room there is.
        if (round >= s.schedule.lines.first_rounds && gain < end.least_gain)
            break;
    }
}

void lengthen_if_useful(GrowState& s, const Directions& directions, const GrowOptions& options,
                        const StageProgress& progress)
{
    const LineSchedule& schedule = s.schedule.lines;
    const double fill = fill_of(s);
    // From a thin start free moves get stuck; in between they do as well without lines.
    const bool between = s.bounded && fill >= schedule.thin_start && fill <= schedule.nearly_full;
    if (!options.grow_lines || (options.free_moves && between))
        return;
    constexpr double kNever = std::numeric_limits<double>::infinity();
    lengthen_lines(s, directions,
                   {options.free_moves && s.bounded ? schedule.least_gain : -1.0,
                    s.bounded ? options.enough_fill.value_or(kNever) : kNever},
                   progress);
}

} // namespace vdb_shell::growth
