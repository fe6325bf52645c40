// SPDX-License-Identifier: Apache-2.0

// Takes: a valid state and a change. Gives: whether it pays, by the tests that look at tets alone;
// most changes fail by one of them. What the tets fill is known before they are looked at: what the
// inner triangles sweep over. So the sum of their other costs, which only grows, ends a trial
// early.

#include "taper/trials.h"

#include "growth/predicates.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

namespace vdb_shell::taper
{
namespace
{

using growth::FaceCorner;

// A change has to win this share of what the pieces cost before, or rounding and small moves to and
// fro would keep changes going.
constexpr double kLeastGain = 1e-4;
// The least share of a Newton step: what does not pass at a sixteenth is held by a contact.
constexpr double kLeastShare = 1.0 / 16;
// A tet breaks SOFA's rule or not, which no gradient sees; a step that counts such tets more often
// gets them over. On the tuned meshes of up to 3,000 triangles the share that breaks it was .121
// with no such step, .113 with 4, .116 with 16 (docs/measurements/tried.md).
constexpr double kPoorShare = 4;

/// Six times the volume between a triangle and a point.
double volume6_to(const Vec3d& p, const std::array<Vec3d, 3>& triangle)
{
    return (triangle[0] - p).cross(triangle[1] - p).dot(triangle[2] - p);
}

} // namespace

/// A new number marks a new list, so no flags have to be cleared: a list has some dozens of pieces
/// of many thousands.
void Trials::begin_list()
{
    ++lists_;
    pieces_.clear();
}

void Trials::list(int layer, int face)
{
    const int piece = layer * s_.faces() + face;
    if (std::exchange(listed_[std::size_t(piece)], lists_) != lists_)
        pieces_.push_back(piece);
}

void Trials::list_around(const std::vector<int>& places)
{
    for (const int place : places) {
        const int level = s_.level_of(place);
        for (const FaceCorner& at : star(*s_.mesh, s_.vertex_of(place))) {
            if (level > 0)
                // A place is a corner of the prisms above it and of those below.
                list(level - 1, at.face);
            if (level < s_.levels)
                list(level, at.face);
        }
    }
}

void Trials::list(const std::vector<int>& pieces)
{
    begin_list();
    pieces_ = pieces;
    sum_before();
}

void Trials::sum_before()
{
    before_ = {};
    volume6_ = 0;
    for (const int piece : pieces_) {
        const PieceCost& c = s_.cost[std::size_t(piece)];
        before_.cost += s_.weights.tet * c.tets + c.distortion;
        before_.worst = std::max(before_.worst, c.worst);
        volume6_ += c.volume6;
    }
    before_.cost -= s_.weights.volume6 * volume6_;
    // The volume is a gain, so a cost may be below nought; the share is taken of its size.
    enough_ = before_.cost - kLeastGain * std::abs(before_.cost);
}

/// Of the pieces together, after the change: they gain what the inner surface loses.
double Trials::volume6_after(const Substitution& change) const
{
    double swept = 0;
    // Seen from the place of the change, triangles that end there have no volume; and it is near,
    // which costs few digits.
    const Vec3d& origin = change.at;
    for (const int index : pieces_) {
        const int face = index - (s_.pieces() - s_.faces());
        if (face < 0)
            continue;
        std::array<Vec3d, 3> now, then;
        for (int k = 0; k < 3; ++k) {
            const int n = s_.corner(s_.levels, face, k);
            const bool changes =
                change.place == Substitution::kAllPlaces
                    ? n == change.from || n == change.to
                    : s_.place(s_.levels, s_.mesh->corner(face, k)) == change.place;
            now[std::size_t(k)] = s_.at(n);
            then[std::size_t(k)] = changes ? change.at : now[std::size_t(k)];
        }
        swept += volume6_to(origin, now) - volume6_to(origin, then);
    }
    return volume6_ + swept;
}

/// A triangle of the surface without a tet would hang on nothing. Where the tets on it are bad at
/// best, that would be cheaper than any change.
bool Trials::loses_last_tet(int piece, const PieceCost& now) const
{
    return piece < s_.faces() && now.tets == 0 && s_.cost[std::size_t(piece)].tets > 0;
}

/// Whether the pieces cost less than that; what they do then, and each of them into cost_.
template <class PieceOf>
bool Trials::cost_less(const PieceOf& piece_at, double volume6, double than, double& cost)
{
    // A shell that has a worse tet already is not held to the bound there, or nothing could be
    // mended.
    const double worst = std::max(before_.worst, s_.weights.worst_distortion);
    cost_.resize(pieces_.size());
    cost = -s_.weights.volume6 * volume6;
    for (std::size_t i = 0; i < pieces_.size(); ++i) {
        PieceCost& c = cost_[i];
        if (!measure(s_, piece_at(pieces_[i]), c) || c.worst > worst ||
            loses_last_tet(pieces_[i], c))
            return false;
        cost += s_.weights.tet * c.tets + c.distortion;
        // Costs of single pieces are not negative, so what is too much now will not become less.
        if (!(cost < than))
            return false;
    }
    return true;
}

bool Trials::costs_less(const Substitution& change, double than, double& cost)
{
    return cost_less([&](int piece) { return piece_of(s_, piece, change); }, volume6_after(change),
                     than, cost);
}

bool Trials::turned_costs_less()
{
    // The two prisms beside the quad fill the same together.
    return cost_less([&](int piece) { return piece_of(s_, piece); }, volume6_, enough_, cost_now_);
}

bool Trials::merge(int from, int to)
{
    const auto &places_from = s_.places[std::size_t(from)], &places_to = s_.places[std::size_t(to)];
    begin_list();
    list_around(places_from);
    list_around(places_to);
    sum_before();
    const Vec3d p = s_.at(from), q = s_.at(to);
    // The point that the other one joins comes first: of equal costs the first stays.
    const std::array<Vec3d, 3> points{q, growth::rounded(0.5 * (p + q)), p};
    // Outer points stay where they are.
    const std::size_t tries = s_.fixed(to) ? 1 : points.size();
    bool any = false;
    cost_now_ = enough_;
    for (std::size_t i = 0; i < tries; ++i) {
        const Substitution change{from, to, points[i]};
        double cost = 0;
        // Each has to beat the best so far, whose costs are kept in best_cost_.
        if (!costs_less(change, cost_now_, cost) || !within_caps(s_, places_from, change.at) ||
            !within_caps(s_, places_to, change.at))
            continue;
        any = true;
        cost_now_ = cost;
        change_ = change;
        cost_.swap(best_cost_);
    }
    cost_.swap(best_cost_);
    return any;
}

/// Steps of Newton's method for the node's own convex problem, zero where there is none: `plain` as
/// the problem is, `for_poor` with tets that break SOFA's rule counted kPoorShare times, where
/// there are any and breaking it costs something.
Trials::Steps Trials::newton_steps(int n) const
{
    Vec3d gradient(0.0), poor_gradient(0.0);
    Symmetric hessian, poor_hessian;
    bool any_poor = false;
    for (const int index : pieces_) {
        const Piece piece = piece_of(s_, index);
        for_each_tet(s_, piece, [&](const auto& tet) {
            std::size_t free = 0;
            while (free < 4 && piece.nodes[tet[free]] != n)
                ++free;
            const TetCorners p = corners_of(piece, tet);
            const double volume = six_volumes(p);
            // A tet that does not have the node does not change; one whose volume rounds to nothing
            // has no distortion to derive.
            if (free == 4 || !(volume > 0))
                return;
            const bool poor = s_.weights.poor > 0 && breaks_sofa_rule(p, volume);
            add_distortion(p, free, volume, s_.weights.power, poor ? poor_gradient : gradient,
                           poor ? poor_hessian : hessian);
            // The gain of volume is affine in the point, so it adds to the gradient and not to the
            // Hessian.
            gradient -= s_.weights.volume6 * volume6_gradient(p, free);
            any_poor = any_poor || poor;
        });
    }
    const auto step_of = [&](double share) {
        Symmetric h = hessian;
        h.add(share, poor_hessian);
        Vec3d step(0.0);
        return solve_positive(h, gradient + share * poor_gradient, step) ? -step : Vec3d(0.0);
    };
    return {step_of(1), any_poor ? step_of(kPoorShare) : Vec3d(0.0)};
}

bool Trials::move(int n)
{
    begin_list();
    list_around(s_.places[std::size_t(n)]);
    sum_before();
    const Steps steps = newton_steps(n);
    step_ = steps.plain;
    share_ = 1;
    const bool passes = shorter_move(n, enough_);
    if (steps.for_poor == Vec3d(0.0))
        return passes;
    // The plain step is kept while the other one is tried, and taken where that is no better.
    const Substitution change = change_;
    const double share = share_, cost = cost_now_;
    cost_.swap(best_cost_);
    step_ = steps.for_poor;
    share_ = 1;
    if (shorter_move(n, passes ? cost : enough_))
        return true;
    step_ = steps.plain;
    share_ = share;
    change_ = change;
    cost_now_ = cost;
    cost_.swap(best_cost_);
    return passes;
}

bool Trials::move_less(const Trial& failed)
{
    const int n = failed.change.to;
    begin_list();
    list_around(s_.places[std::size_t(n)]);
    sum_before();
    step_ = failed.step;
    // Listed anew, for the trial may be another thread's.
    share_ = failed.share / 2;
    return shorter_move(n, enough_);
}

/// By share_ of the step, or less.
bool Trials::shorter_move(int n, double than)
{
    const Vec3d& here = s_.at(n);
    for (; share_ >= kLeastShare; share_ /= 2) {
        change_ = {n, n, growth::rounded(here + share_ * step_)};
        if (!change_.at.isFinite()) // as a float
            continue;
        // The step is less than a rounding, and shorter ones would be too.
        if (change_.at == here)
            return false;
        if (costs_less(change_, than, cost_now_) &&
            within_caps(s_, s_.places[std::size_t(n)], change_.at))
            return true;
    }
    return false;
}

bool Trials::hand_over(int place, int to)
{
    begin_list();
    list_around({place});
    sum_before();
    change_ = {s_.node[std::size_t(place)], to, s_.at(to), place};
    return costs_less(change_, enough_, cost_now_) && within_caps(s_, {place}, change_.at);
}

} // namespace vdb_shell::taper
