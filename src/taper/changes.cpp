// SPDX-License-Identifier: Apache-2.0

// Takes: a valid state and one change. Leaves: a valid state that costs less, or the state as it
// was. The tests are those of docs/theory.md, "Tapered shells": tets positive, inner triangles
// without contacts, no part of the inner surface passed; the cheapest comes first, as most changes
// fail by their cost or by a sign.

#include "taper/changes.h"

#include "growth/predicates.h"

#include <algorithm>
#include <array>
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
// Halvings of a Newton step: what does not pass at a sixteenth is held by a contact.
constexpr int kHalvings = 5;

} // namespace

void Changes::begin_list()
{
    ++lists_;
    pieces_.clear();
    swept_.clear();
}

void Changes::list(int layer, int face)
{
    const int piece = layer * s_.faces() + face;
    if (std::exchange(listed_[std::size_t(piece)], lists_) != lists_)
        pieces_.push_back(piece);
}

void Changes::list_around(const std::vector<int>& places)
{
    for (const int place : places) {
        const int level = s_.level_of(place);
        for (const FaceCorner& at : star(*s_.mesh, s_.vertex_of(place))) {
            if (level > 0)
                list(level - 1, at.face);
            if (level < s_.levels)
                list(level, at.face);
        }
    }
}

Changes::Sum Changes::present() const
{
    Sum sum{0, 0, true};
    for (const int piece : pieces_) {
        const PieceCost& c = s_.cost[std::size_t(piece)];
        sum.cost += s_.weights.tet * c.tets + c.distortion - s_.weights.volume6 * c.volume6;
        sum.worst = std::max(sum.worst, c.worst);
    }
    return sum;
}

/// Of the pieces as they are now, into cost_.
Changes::Sum Changes::measured()
{
    cost_.resize(pieces_.size());
    Sum sum{0, 0, false};
    for (std::size_t i = 0; i < pieces_.size(); ++i) {
        PieceCost& c = cost_[i];
        if (!measure_piece(s_, pieces_[i], c) || loses_last_tet(pieces_[i], c))
            return sum;
        sum.cost += s_.weights.tet * c.tets + c.distortion - s_.weights.volume6 * c.volume6;
        sum.worst = std::max(sum.worst, c.worst);
    }
    sum.valid = true;
    return sum;
}

/// A triangle of the surface without a tet would hang on nothing. Where the tets on it are bad at
/// best, that would be cheaper than any change.
bool Changes::loses_last_tet(int piece, const PieceCost& now) const
{
    return piece < s_.mesh->face_count() && now.tets == 0 && s_.cost[std::size_t(piece)].tets > 0;
}

bool Changes::better(const Sum& now) const
{
    return now.valid && now.cost < before_.cost - kLeastGain * std::abs(before_.cost) &&
           now.worst <= std::max(before_.worst, s_.weights.worst_distortion);
}

void Changes::accept()
{
    for (std::size_t i = 0; i < pieces_.size(); ++i)
        s_.cost[std::size_t(pieces_[i])] = cost_[i];
    update_inner_tree(s_, pieces_);
}

/// Tells the places of node `from` that they belong to `to`, without telling `to`.
void Changes::point_places(int from, int to)
{
    for (const int place : s_.places[std::size_t(from)])
        s_.node[std::size_t(place)] = to;
}

bool Changes::merge(int from, int to)
{
    auto& places_from = s_.places[std::size_t(from)];
    auto& places_to = s_.places[std::size_t(to)];
    begin_list();
    list_around(places_from);
    list_around(places_to);
    before_ = present();
    list_swept(s_, pieces_, from, swept_);
    const auto of_from = std::ptrdiff_t(swept_.size());
    list_swept(s_, pieces_, to, swept_);
    // A triangle that has both is swept over once.
    swept_.erase(std::remove_if(swept_.begin() + of_from, swept_.end(),
                                [from](const Swept& t) {
                                    return t.nodes[0] == from || t.nodes[1] == from ||
                                           t.nodes[2] == from;
                                }),
                 swept_.end());
    const Vec3d p = s_.at(from), q = s_.at(to);
    point_places(from, to);
    const std::array<Vec3d, 3> tries{q, growth::rounded(0.5 * (p + q)), p};
    Sum best{std::numeric_limits<double>::infinity(), 0, false};
    std::vector<PieceCost> best_cost;
    Vec3d at = q;
    for (const Vec3d& x : tries) {
        // Outer points stay where they are.
        if (s_.fixed(to) && &x != tries.data())
            break;
        s_.point[std::size_t(to)] = x;
        const Sum sum = measured();
        if (better(sum) && sum.cost < best.cost && within_caps(s_, places_from, x) &&
            within_caps(s_, places_to, x)) {
            best = sum;
            best_cost = cost_;
            at = x;
        }
    }
    s_.point[std::size_t(to)] = at;
    for (Swept& tet : swept_)
        tet.corners[3] = at;
    if (!best.valid || passes_itself(s_, swept_, pieces_, {from, to}) ||
        !inner_triangles_clear(s_, pieces_)) {
        point_places(from, from);
        s_.point[std::size_t(to)] = q;
        return false;
    }
    cost_ = std::move(best_cost);
    const auto middle = std::ptrdiff_t(places_to.size());
    places_to.insert(places_to.end(), places_from.begin(), places_from.end());
    std::inplace_merge(places_to.begin(), places_to.begin() + middle, places_to.end());
    places_from.clear();
    accept();
    return true;
}

/// Zero where there is none.
Vec3d Changes::newton_step(int n) const
{
    Vec3d gradient(0.0), step(0.0);
    Symmetric hessian;
    for (const int piece : pieces_)
        for_each_tet(s_, piece, [&](const TetNodes& t) {
            const auto free =
                static_cast<std::size_t>(std::find(t.begin(), t.end(), n) - t.begin());
            if (free == t.size())
                return;
            const TetCorners p = corners_of(s_, t);
            const double volume = six_volumes(p);
            if (!(volume > 0))
                return;
            add_distortion(p, free, volume, s_.weights.power, gradient, hessian);
            gradient -= s_.weights.volume6 * volume6_gradient(p, free);
        });
    return solve_positive(hessian, gradient, step) ? -step : Vec3d(0.0);
}

bool Changes::move(int n)
{
    begin_list();
    list_around(s_.places[std::size_t(n)]);
    before_ = present();
    const Vec3d here = s_.at(n), step = newton_step(n);
    list_swept(s_, pieces_, n, swept_);
    double share = 1;
    for (int i = 0; i < kHalvings; ++i, share *= 0.5) {
        const Vec3d x = growth::rounded(here + share * step);
        if (x == here)
            break;
        s_.point[std::size_t(n)] = x;
        for (Swept& tet : swept_)
            tet.corners[3] = x;
        if (better(measured()) && within_caps(s_, s_.places[std::size_t(n)], x) &&
            !passes_itself(s_, swept_, pieces_, {n, n}) && inner_triangles_clear(s_, pieces_)) {
            accept();
            return true;
        }
    }
    s_.point[std::size_t(n)] = here;
    return false;
}

bool Changes::hand_over(int place, int to)
{
    const int from = s_.node[std::size_t(place)];
    begin_list();
    list_around({place});
    before_ = present();
    if (s_.level_of(place) == s_.levels)
        for (const FaceCorner& at : star(*s_.mesh, s_.vertex_of(place))) {
            const int p = s_.corner(s_.levels, at.face, (at.local + 1) % 3),
                      q = s_.corner(s_.levels, at.face, (at.local + 2) % 3);
            if (p != q && p != from && q != from && p != to && q != to)
                swept_.push_back({{from, p, q}, {s_.at(from), s_.at(p), s_.at(q), s_.at(to)}});
        }
    s_.node[std::size_t(place)] = to;
    if (!better(measured()) || !within_caps(s_, {place}, s_.at(to)) ||
        passes_itself(s_, swept_, pieces_, {from, to}) || !inner_triangles_clear(s_, pieces_)) {
        s_.node[std::size_t(place)] = from;
        return false;
    }
    auto& left = s_.places[std::size_t(from)];
    left.erase(std::find(left.begin(), left.end(), place));
    auto& joined = s_.places[std::size_t(to)];
    joined.insert(std::upper_bound(joined.begin(), joined.end(), place), place);
    accept();
    return true;
}

bool Changes::turn(int layer, int edge)
{
    begin_list();
    for (const int face : s_.faces_of_edge[std::size_t(edge)])
        list(layer, face);
    before_ = present();
    std::uint8_t& diagonal = s_.diagonal_of(layer, edge);
    diagonal ^= 1U;
    if (better(measured())) {
        accept();
        return true;
    }
    diagonal ^= 1U;
    return false;
}

} // namespace vdb_shell::taper
