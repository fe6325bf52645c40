// SPDX-License-Identifier: Apache-2.0

// Takes: the schedule, the user's options and what growth goes on from. Gives: the options of one
// run of relax(). Nothing here touches the shell. After a prolongation most is done, and growth
// goes on only as long as that pays or the shell is less full than the schedule wants it, unless
// the options want more (docs/growth.md).

#include "growth/relax_options.h"

#include <algorithm>
#include <utility>

namespace vdb_shell::growth
{
namespace
{

/// Whether growth stops as soon as it wins little for its cost.
bool thrifty(StartedFrom from, const GrowOptions& options)
{
    // From lines all volume is yet to be won, and a thinner shell would show.
    return from == StartedFrom::prolonged && !asks_for_more(options);
}

double first_weight(const GrowState& s, StartedFrom from, bool saves_time)
{
    if (from == StartedFrom::lines)
        return s.schedule.barrier.first_weight;
    // In proportion to the void: a barrier that weighs more would push the inner surface back.
    return (saves_time ? 1 : 2) * s.schedule.multilevel.first_weight_over_void * (1 - fill_of(s));
}

int most_rounds(const GrowState& s, StartedFrom from, const GrowOptions& options)
{
    return thrifty(from, options) ? affordable_rounds(s.mesh->faces.size(), s.schedule)
                                  : options.free_rounds.value_or(s.schedule.barrier.most_rounds);
}

double weight_decrease(const GrowState& s, StartedFrom from, const GrowOptions& options)
{
    const BarrierSchedule& barrier = s.schedule.barrier;
    if (options.method == Method::thickest)
        return from == StartedFrom::prolonged ? barrier.weight_decrease_thickest_prolonged
                                              : barrier.weight_decrease_thickest;
    return thrifty(from, options) ? barrier.weight_decrease_prolonged : barrier.weight_decrease;
}

double least_gain(const GrowState& s, const GrowOptions& options)
{
    return options.method == Method::thickest ? s.schedule.barrier.least_gain_thickest
                                              : s.schedule.barrier.least_gain;
}

/// On the surface itself. Of a large one long radii would take far too many planes, from lines too;
/// next to a void that stays planes are few.
bool short_first_radii(const GrowState& s, StartedFrom from, const GrowOptions& options)
{
    const bool large = options.coarse_from > 0 && s.mesh->faces.size() >= options.coarse_from;
    return (from == StartedFrom::prolonged || large) && fills_void(s);
}

/// RelaxOptions::active_gain. Who asks for more has all vertices active.
double active_gain(const GrowState& s, StartedFrom from, const GrowOptions& options)
{
    const ActiveSetSchedule& active = s.schedule.active;
    if (thrifty(from, options))
        return active.gain_per_vertex * std::min(1.0, s.mesh->vertices / active.full_size);
    // One share of the solid over all vertices: from lines a vertex is tried until all of them
    // together win next to nothing.
    return asks_for_more(options) ? 0 : active.gain_of_all / s.mesh->vertices;
}

/// Rounds go on until the shell is as full as the schedule wants it.
void want_more(const GrowState& s, RelaxOptions& relax)
{
    if (!fills_void(s))
        return;
    relax.wanted_fill = s.schedule.multilevel.wanted_fill;
    relax.wanted_gain_of_void = s.schedule.multilevel.wanted_gain_of_void;
    relax.wanted_active_gain_of_void = s.schedule.active.gain_of_void;
}

} // namespace

bool asks_for_more(const GrowOptions& options)
{
    return options.method == Method::thickest || options.free_rounds;
}

int affordable_rounds(std::size_t triangles, const GrowthSchedule& schedule)
{
    // Falls with the square: a round on more triangles costs more, and it wins less, since the
    // surfaces before have won most. One is always worth it: it wins back what mending has lost.
    const double over = schedule.multilevel.one_round_triangles / double(triangles);
    return static_cast<int>(std::clamp(over * over, 1.0, double(schedule.barrier.most_rounds)));
}

RelaxOptions relax_coarse(const GrowState& s, StartedFrom from, std::size_t triangles)
{
    const MultilevelSchedule& schedule = s.schedule.multilevel;
    const double paid_for = schedule.cost_share * double(triangles) / s.mesh->face_count();
    // Rounds on a coarse surface are cheap next to those on the whole, so they are counted by cost.
    RelaxOptions relax;
    relax.most_rounds =
        std::max(affordable_rounds(s.mesh->faces.size(), s.schedule),
                 static_cast<int>(std::min(double(s.schedule.barrier.most_rounds), paid_for)));
    relax.short_first_radii = from == StartedFrom::prolonged && fills_void(s);
    const bool after_twelve = from == StartedFrom::lines && !s.twelve;
    relax.first_weight =
        after_twelve ? s.schedule.barrier.first_weight_three : first_weight(s, from, true);
    relax.weight_decrease = from == StartedFrom::prolonged ? schedule.weight_decrease
                                                           : schedule.coarsest_weight_decrease;
    relax.least_gain = s.schedule.barrier.least_gain;
    relax.end_weight = schedule.end_weight;
    relax.end_gain_of_void = schedule.end_gain_of_void;
    if (from == StartedFrom::prolonged)
        want_more(s, relax);
    return relax;
}

RelaxOptions relax_whole(const GrowState& s, StartedFrom from, const GrowOptions& options,
                         std::vector<double> predicted_gain, const AttemptRounds& rounds)
{
    const bool saves_time = thrifty(from, options);
    RelaxOptions relax;
    relax.most_rounds = most_rounds(s, from, options);
    relax.short_first_radii = short_first_radii(s, from, options);
    if (options.method == Method::thickest)
        relax.most_rounds =
            std::min(relax.most_rounds, s.schedule.barrier.twelve_rounds_before_three);
    relax.first_weight = first_weight(s, from, saves_time);
    relax.weight_decrease = weight_decrease(s, from, options);
    relax.keep_weight = rounds.keep_weight && fills_void(s);
    relax.fill_to_beat = rounds.fill_to_beat;
    relax.least_gain = least_gain(s, options);
    relax.active_gain = active_gain(s, from, options);
    // Only where time is to be saved may a round that wins too little end it early on.
    if (saves_time) {
        relax.least_gain_per_vertex = s.schedule.active.gain_share_to_go_on * relax.active_gain;
        want_more(s, relax);
    }
    relax.predicted_gain = std::move(predicted_gain);
    return relax;
}

RelaxOptions relax_thickest(const GrowState& s, StartedFrom from, const GrowOptions& options)
{
    RelaxOptions relax;
    relax.most_rounds = most_rounds(s, from, options);
    relax.short_first_radii = short_first_radii(s, from, options);
    // No gain is predicted, so all vertices are active at first: under the new test every vertex
    // has new room. From lines they stay so.
    if (from == StartedFrom::prolonged) {
        relax.first_weight = first_weight(s, from, true);
        relax.active_gain = s.schedule.active.gain_of_all_thickest / s.mesh->vertices;
    } else {
        relax.first_weight = s.schedule.barrier.first_weight_three;
    }
    relax.weight_decrease = weight_decrease(s, from, options);
    relax.least_gain = least_gain(s, options);
    return relax;
}

} // namespace vdb_shell::growth
