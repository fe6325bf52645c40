// SPDX-License-Identifier: Apache-2.0

// Takes: a valid shell. Leaves: a valid shell that is at least as thick. An interior-point method
// by blocks of one vertex: in each round separating planes are put between all triangles that could
// meet, every active vertex in turn takes a step towards the minimum of its convex problem (volume
// plus barrier), as far as the exact tests allow, and then the barrier weight is lowered. Sources:
// docs/theory.md, "Growth"; barrier method: Boyd and Vandenberghe 2004, "Convex Optimization",
// chapter 11.

#include "growth/relax.h"

#include "growth/active_set.h"
#include "growth/barrier.h"
#include "growth/diagonals.h"
#include "growth/pins.h"
#include "growth/sweep.h"
#include "growth/trust_radius.h"

#include <tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace vdb_shell::growth
{
namespace
{

/// Adds the near planes, which together weigh no more than a few tets: there may be dozens, and
/// most say the same.
void add_plane_bounds(const GrowState& s, const SeparatingPlanes& planes, int v,
                      LinearBounds& bounds)
{
    const double range = s.schedule.barrier.plane_range * s.trust_radius[v];
    const std::size_t first = bounds.size();
    all_planes_of(planes, v, [&](const SeparatingPlane& plane, double sign) {
        const double value = sign * plane.value(s.b[v]);
        if (value < range)
            bounds.add_unit(plane.n * static_cast<float>(sign), value);
        return true;
    });
    const auto count = static_cast<float>(bounds.size() - first);
    const float weight = s.schedule.barrier.planes_weight;
    if (count > weight)
        bounds.weigh(first, weight / count);
}

/// Where a solid has no bound there is no end to what can be filled: then what the lines have
/// filled stands for it.
double volume6_to_fill(const GrowState& s, double first_fill)
{
    const double enclosed = std::abs(volume6(s.a, s.mesh->faces));
    return s.bounded ? enclosed : enclosed * first_fill;
}

/// The inner surface and what belongs to it, to go back to.
struct Saved {
    std::vector<Vec3d> b;
    std::vector<std::uint8_t> order, pinned;
};

class Relaxation
{
public:
    Relaxation(GrowState& s, const GrowOptions& options, const RelaxOptions& relax_options)
        : s_(s), options_(options), relax_(relax_options), schedule_(s.schedule.barrier),
          fill_(fill_of(s))
    {
        mean_tet_ = volume6_to_fill(s, fill_) / (3.0 * std::max(1, s.mesh->face_count()));
        // In an unbounded side there is no void to measure the weight by.
        weight_ = relax_.first_weight;
        if (s.bounded)
            weight_ = std::min(weight_, std::max(schedule_.least_weight,
                                                 schedule_.most_weight_over_void * (1 - fill_)));
        solid6_ = std::abs(volume6(s.a, s.mesh->faces));
        set_.gain = relax_.predicted_gain;
        set_.idle_rounds.assign(s.b.size(), 0);
        set_first_radii(s, relax_.short_first_radii ||
                               (s.bounded && fill_ > s.schedule.radius.short_from_fill));
    }

    double fill() const { return fill_; }
    bool full() const { return s_.bounded && fill_ >= schedule_.enough_fill; }
    /// Whether the shell is less full than wanted, so that rounds go on.
    bool wants_more() const { return fill_ < relax_.wanted_fill; }
    /// Whether so many more rounds like the last would not do. While the weight falls a round may
    /// win less than those after it.
    bool falls_short(int rounds) const
    {
        return weight_ <= schedule_.least_weight &&
               fill_ + rounds * last_gain_ < relax_.fill_to_beat;
    }

    /// One round: separating planes, sweeps, trust radii, diagonals, barrier weight. False if no
    /// other should follow.
    bool round(GrowReport& report)
    {
        // The planes are those of this round's active vertices and of their radii, so both are
        // chosen before them and stay as they are until the next round.
        const std::vector<std::uint8_t> inactive = next_inactive();
        const std::ptrdiff_t active = std::count(inactive.begin(), inactive.end(), 0);
        separate_triangles(s_, inactive, planes_,
                           settled() ? TreeUpdate::refit : TreeUpdate::rebuild);
        sweeps(inactive);
        // What a vertex has won is what it is predicted to win in the next round.
        if (active_gain() > 0)
            measure_gain(s_, inactive, set_.gain);
        count_idle_rounds(s_, set_);
        adapt_radii(s_, inactive);
        // Under the twelve-tet test a diagonal makes no room: all of them are valid already.
        if (options_.flips && !s_.twelve)
            report.flips += flip_for_room(s_);
        ++report.rounds;
        const double gain = fill_of(s_) - fill_;
        fill_ += gain;
        last_gain_ = gain;
        if (wants_more() ? !goes_on(gain) : ends_after(gain, static_cast<double>(active)))
            return false;
        lower_weight(gain);
        return true;
    }

private:
    bool settled() const { return weight_ < schedule_.settled_weight; }
    /// While jams are being undone a vertex that has won nothing may have to make room all the
    /// same.
    bool by_gain() const { return active_gain() > 0 && settled(); }

    /// RelaxOptions::active_gain, or what takes its place, as six times a volume.
    double active_gain() const
    {
        if (!wants_more())
            return solid6_ * relax_.active_gain;
        const double of_void = relax_.wanted_active_gain_of_void * (widened_ ? 0.5 : 1);
        return solid6_ * (of_void * (1 - fill_) / s_.mesh->vertices);
    }

    /// Whether another round follows while the shell is less full than wanted: unless this one won
    /// little. The first that does is forgiven: all vertices are active in the next, and half as
    /// much makes one active after it.
    bool goes_on(double gain)
    {
        if (gain > relax_.wanted_gain_of_void * (1 - fill_))
            return true;
        if (widened_)
            return false;
        set_.gain.clear();
        return widened_ = true;
    }

    std::vector<std::uint8_t> next_inactive() const
    {
        std::vector<std::uint8_t> inactive = inactive_vertices(s_, set_);
        if (by_gain() && !set_.gain.empty())
            leave_out_satisfied(s_, set_, active_gain(), inactive);
        return inactive;
    }

    void sweeps(const std::vector<std::uint8_t>& inactive)
    {
        std::vector<std::uint8_t> left_out = inactive;
        for (int i = 0; i < schedule_.sweeps; ++i) {
            if (i > 0)
                // The first sweep leaves most planes off the middle, with room on one side only.
                recentre_planes(s_, planes_);
            if (i > 0 && by_gain())
                leave_out_spent(s_, s_.schedule.active.gain_share_in_round * active_gain(),
                                left_out);
            sweep(s_, planes_, left_out,
                  [&](int v, Vec3d& x) { return propose_move(v, bounds_.local(), x); });
        }
    }

    /// The minimum of the vertex's own problem, or the first point on the way to it, by halves,
    /// that the exact tests allow.
    bool propose_move(int v, LinearBounds& bounds, Vec3d& out) const
    {
        bounds.clear(s_.b[v], s_.trust_radius[v]);
        tet_bounds(s_, v, bounds);
        if (options_.soft_contacts)
            add_plane_bounds(s_, planes_, v, bounds);
        // Without the ball a vertex that only its cap holds would be sent far away, sideways as
        // well, for the volume has no minimum.
        const Ball cap{s_.a[v], schedule_.cap_factor * s_.cap[v]};
        const Vec3d target = within_trust_radius(
            s_, v,
            barrier_minimum(bounds, cap, inner_volume6_gradient(s_, v), mean_tet_ * weight_));
        const Vec3d full = capped(s_, v, target) - s_.b[v];
        const double shortest = schedule_.shortest_move * s_.diagonal;
        // The problem is convex and the vertex is valid where it is, so a shorter move is the more
        // likely to pass.
        double share = 1;
        for (int i = 0; i < schedule_.halvings && share * full.length() > shortest; ++i) {
            out = capped(s_, v, s_.b[v] + share * full);
            if (move_allowed(s_, planes_, v, out))
                return true;
            share *= 0.5;
        }
        return false;
    }

    bool ends_after(double gain, double active) const
    {
        const bool coarse_done =
            weight_ < relax_.end_weight && gain <= relax_.end_gain_of_void * (1 - fill_);
        const bool too_dear = gain <= relax_.least_gain_per_vertex * active;
        const bool converged = weight_ <= schedule_.least_weight && gain < relax_.least_gain;
        return coarse_done || too_dear || converged;
    }

    /// Faster where a round neither wins nor undoes much.
    void lower_weight(double gain)
    {
        if (relax_.keep_weight && schedule_.most_rounds * gain > 1 - fill_)
            return;
        const bool stale = settled() && std::abs(gain) < schedule_.stale_gain;
        const double factor = stale ? schedule_.weight_decrease_stale : relax_.weight_decrease;
        weight_ = std::max(schedule_.least_weight, weight_ * factor);
    }

    GrowState& s_;
    const GrowOptions& options_;
    const RelaxOptions& relax_;
    const BarrierSchedule& schedule_;
    double fill_;
    double last_gain_ = 0; ///< of a round
    double mean_tet_ = 0;  ///< six times the mean volume of a tet, were the solid full
    double weight_ = 0;    ///< of the barrier, in mean tets
    double solid6_ = 0;    ///< six times the solid's volume
    bool widened_ = false; ///< whether all vertices have been made active once more
    ActiveSet set_;
    SeparatingPlanes planes_;
    tbb::enumerable_thread_specific<LinearBounds> bounds_;
};

bool is_power_of_two_or_zero(int n)
{
    return (n & (n - 1)) == 0;
}

} // namespace

void relax(GrowState& s, const std::vector<double>& visibility, const GrowOptions& options,
           const RelaxOptions& relax_options, const StageProgress& progress, GrowReport& report)
{
    // The barrier may end below where it began, when there was next to nothing to win.
    const Saved first{s.b, s.order, s.pinned};
    Relaxation relaxation(s, options, relax_options);
    const double first_fill = relaxation.fill();
    const auto most_rounds = [&] {
        return relaxation.wants_more() ? s.schedule.barrier.most_rounds : relax_options.most_rounds;
    };
    for (int round = 0; round < most_rounds() && !relaxation.full(); ++round) {
        progress.stop_if_interrupted(100.0 * round / most_rounds());
        // Ever more seldom: a pin that cannot go now will hardly be able to in the next round.
        if (is_power_of_two_or_zero(round))
            report.released +=
                static_cast<std::size_t>(release_pins(s, visibility, PillarsBesidePin::kept));
        if (!relaxation.round(report) || relaxation.falls_short(most_rounds() - round - 1))
            break;
    }
    if (relaxation.fill() < first_fill) {
        s.b = first.b;
        s.order = first.order;
        s.pinned = first.pinned;
    }
}

void test_three_tets(GrowState& s)
{
    if (!s.twelve)
        return;
    // What the twelve-tet test allowed the three-tet test allows too, under any order.
    s.twelve = false;
    order_by_length(s);
}

void relax_fully(GrowState& s, StartedFrom from, std::vector<double> predicted_gain,
                 const std::vector<double>& visibility, const GrowOptions& options,
                 const AttemptRounds& rounds, const StageProgress& progress, GrowReport& report)
{
    const bool once_more = options.method == Method::thickest;
    if (!once_more && prism_test_of(options) == PrismTest::chosen_tets)
        test_three_tets(s);
    const double changed_at = !once_more ? 100 : s.twelve ? 50 : 0;
    if (s.twelve || !once_more)
        relax(s, visibility, options,
              relax_whole(s, from, options, std::move(predicted_gain), rounds),
              progress.part(0, changed_at), report);
    if (!once_more)
        return;
    test_three_tets(s);
    relax(s, visibility, options, relax_thickest(s, from, options), progress.part(changed_at, 100),
          report);
}

} // namespace vdb_shell::growth
