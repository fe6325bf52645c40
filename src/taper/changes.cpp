// SPDX-License-Identifier: Apache-2.0

// Takes: a valid state. Leaves: a valid state that costs less.

#include "taper/changes.h"

#include "taper/tet_shape.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace vdb_shell::taper
{
namespace
{

using growth::FaceCorner;

/// A change has to win this share of what the tets around it cost, or rounding would keep changes
/// going for ever.
constexpr double kLeastGain = 1e-4;

bool worth_it(const TaperState& s, const Cost& before, const Cost& after)
{
    return after.positive && after.sum < before.sum - kLeastGain * std::abs(before.sum) &&
           after.worst <= std::max(before.worst, s.weights.most_amips);
}

/// Puts the places of `from` under `to`, or takes that back.
void hand_over(TaperState& s, int from, int to)
{
    auto& target = s.places[std::size_t(to)];
    const auto middle = std::ptrdiff_t(target.size());
    for (const int place : s.places[std::size_t(from)]) {
        s.node[std::size_t(place)] = to;
        target.push_back(place);
    }
    std::inplace_merge(target.begin(), target.begin() + middle, target.end());
    s.places[std::size_t(from)].clear();
}

} // namespace

bool merge(TaperState& s, int from, int to)
{
    // Outer nodes stay where they are, so they can only take others in.
    if (s.fixed(from))
        std::swap(from, to);
    if (s.fixed(from))
        return false;
    std::vector<int> pieces;
    begin_list(s);
    list_pieces(s, from, pieces);
    list_pieces(s, to, pieces);
    const Cost before = cost_of(s, pieces);
    const std::vector<int> places_from = s.places[std::size_t(from)],
                           places_to = s.places[std::size_t(to)];
    const Vec3d p = s.point[std::size_t(from)], q = s.point[std::size_t(to)];
    std::vector<Swept> swept;
    // Where it goes is known later. A triangle with both nodes is listed once.
    list_swept(s, pieces, from, p, swept);
    const auto of_from = std::ptrdiff_t(swept.size());
    list_swept(s, pieces, to, q, swept);
    swept.erase(std::remove_if(swept.begin() + of_from, swept.end(),
                               [&](const Swept& t) {
                                   return std::find(t.nodes.begin(), t.nodes.end(), from) !=
                                          t.nodes.end();
                               }),
                swept.end());
    hand_over(s, from, to);
    const auto undo = [&] {
        for (const int place : places_from)
            s.node[std::size_t(place)] = from;
        s.places[std::size_t(from)] = places_from;
        s.places[std::size_t(to)] = places_to;
        s.point[std::size_t(to)] = q;
        return false;
    };
    Cost best;
    best.positive = false;
    best.sum = std::numeric_limits<double>::infinity();
    Vec3d at = q;
    std::vector<Vec3d> tries{q};
    if (!s.fixed(to))
        tries = {q, p, growth::rounded(0.5 * (p + q))};
    for (const Vec3d& x : tries) {
        s.point[std::size_t(to)] = x;
        const Cost cost = cost_of(s, pieces);
        if (cost.positive && cost.sum < best.sum && within_caps(s, to, x)) {
            best = cost;
            at = x;
        }
    }
    if (!worth_it(s, before, best))
        return undo();
    s.point[std::size_t(to)] = at;
    for (Swept& t : swept) {
        t.corners[3] = at;
        t.centre = to;
        std::replace(t.nodes.begin(), t.nodes.end(), from, to);
    }
    if (passes_a_node(s, swept) || !inner_triangles_clear(s, pieces))
        return undo();
    update_tree(s, pieces);
    return true;
}

bool move(TaperState& s, int n)
{
    std::vector<int> pieces;
    begin_list(s);
    list_pieces(s, n, pieces);
    const Vec3d here = s.point[std::size_t(n)];
    Vec3d gradient(0.0);
    Symmetric hessian;
    for (const int piece : pieces)
        for_each_tet(s, piece, [&](const TetNodes& t) {
            for (std::size_t i = 0; i < 4; ++i) {
                if (t[i] != n)
                    continue;
                const std::array<Vec3d, 4> p{s.point[std::size_t(t[0])], s.point[std::size_t(t[1])],
                                             s.point[std::size_t(t[2])],
                                             s.point[std::size_t(t[3])]};
                const double six = six_volumes(p[0], p[1], p[2], p[3]);
                if (!(six > 0))
                    continue;
                add_shape(p, i, six, s.weights.exponent, gradient, hessian);
                const Vec3d &q = p[(i + 1) % 4], &r = p[(i + 2) % 4], &u = p[(i + 3) % 4];
                gradient -= s.weights.volume6 * (i % 2 == 0 ? -1.0 : 1.0) *
                            (r - q).cross(u - q);
            }
        });
    Vec3d step;
    if (!solve_positive(hessian, gradient, step))
        return false;
    const Cost before = cost_of(s, pieces);
    double share = 1;
    for (int i = 0; i < 5; ++i, share *= 0.5) {
        const Vec3d x = growth::rounded(here - share * step);
        s.point[std::size_t(n)] = here;
        std::vector<Swept> swept;
        list_swept(s, pieces, n, x, swept);
        s.point[std::size_t(n)] = x;
        Cost after = cost_of(s, pieces);
        if (after.positive && after.sum < before.sum && within_caps(s, n, x) &&
            !passes_a_node(s, swept) && inner_triangles_clear(s, pieces)) {
            update_tree(s, pieces);
            return true;
        }
    }
    s.point[std::size_t(n)] = here;
    return false;
}

bool reassign(TaperState& s, int place, int to)
{
    const int from = s.node[std::size_t(place)];
    if (from == to || s.fixed(from) || s.places[std::size_t(from)].size() < 2)
        return false;
    const int faces = s.faces(), level = place / s.vertices(), v = place % s.vertices();
    std::vector<int> pieces;
    for (const FaceCorner& at : star(*s.mesh, v))
        for (int layer = std::max(0, level - 1); layer < std::min(s.levels, level + 1); ++layer)
            pieces.push_back(layer * faces + at.face);
    const Cost before = cost_of(s, pieces);
    std::vector<Swept> swept;
    if (level == s.levels)
        for (const FaceCorner& at : star(*s.mesh, v)) {
            const int f = at.face;
            const int p = s.corner(level, f, (at.local + 1) % 3),
                      q = s.corner(level, f, (at.local + 2) % 3);
            if (p != q && p != to && q != to && p != from && q != from)
                swept.push_back({{from, p, q},
                                 to,
                                 {s.point[std::size_t(from)], s.point[std::size_t(p)],
                                  s.point[std::size_t(q)], s.point[std::size_t(to)]}});
        }
    s.node[std::size_t(place)] = to;
    const Cost after = cost_of(s, pieces);
    const auto v_point = std::size_t(v);
    if (!worth_it(s, before, after) ||
        exact::longer_than(Vec3s(s.point[v_point]), Vec3s(s.point[std::size_t(to)]),
                           s.cap[v_point]) ||
        passes_a_node(s, swept) || !inner_triangles_clear(s, pieces)) {
        s.node[std::size_t(place)] = from;
        return false;
    }
    auto& old_places = s.places[std::size_t(from)];
    old_places.erase(std::find(old_places.begin(), old_places.end(), place));
    auto& new_places = s.places[std::size_t(to)];
    new_places.insert(std::upper_bound(new_places.begin(), new_places.end(), place), place);
    update_tree(s, pieces);
    return true;
}

bool turn(TaperState& s, int layer, int edge)
{
    const auto& beside = s.faces_of_edge[std::size_t(edge)];
    const std::vector<int> pieces{layer * s.faces() + beside[0], layer * s.faces() + beside[1]};
    std::uint8_t& diagonal =
        s.diagonal[std::size_t(layer) * s.edges.size() + std::size_t(edge)];
    const Cost now = cost_of(s, pieces);
    diagonal ^= 1U;
    if (worth_it(s, now, cost_of(s, pieces)))
        return true;
    diagonal ^= 1U;
    return false;
}

std::size_t merge_pass(TaperState& s)
{
    struct Candidate {
        double length;
        int from, to;
        bool operator<(const Candidate& o) const
        {
            return std::tie(length, from, to) < std::tie(o.length, o.from, o.to);
        }
    };
    std::vector<Candidate> list;
    const auto add = [&](int p, int q) {
        if (p > q)
            std::swap(p, q);
        if (p != q && !s.fixed(q))
            list.push_back({(s.point[std::size_t(p)] - s.point[std::size_t(q)]).length(), q, p});
    };
    for (int level = 1; level <= s.levels; ++level)
        for (int v = 0; v < s.vertices(); ++v) {
            for (const int u : neighbours(*s.mesh, v))
                if (u < v)
                    add(s.node_at(level, u), s.node_at(level, v));
            if (s.vertical)
                add(s.node_at(level, v), s.node_at(level - 1, v));
        }
    std::sort(list.begin(), list.end());
    list.erase(std::unique(list.begin(), list.end(),
                           [](const Candidate& a, const Candidate& b) {
                               return a.from == b.from && a.to == b.to;
                           }),
               list.end());
    std::vector<int> now(s.places.size());
    for (std::size_t n = 0; n < now.size(); ++n)
        now[n] = static_cast<int>(n);
    const auto find = [&](int n) {
        while (now[std::size_t(n)] != n)
            n = now[std::size_t(n)];
        return n;
    };
    std::size_t made = 0;
    for (const Candidate& c : list) {
        int from = find(c.from), to = find(c.to);
        if (from == to)
            continue;
        // The larger group keeps its node: fewer places change hands.
        if (s.fixed(from) || (!s.fixed(to) && s.places[std::size_t(from)].size() >
                                                   s.places[std::size_t(to)].size()))
            std::swap(from, to);
        if (s.fixed(from))
            continue;
        if (merge(s, from, to)) {
            now[std::size_t(from)] = to;
            ++made;
        }
    }
    rebuild_tree(s);
    return made;
}

std::size_t move_pass(TaperState& s)
{
    std::size_t made = 0;
    for (int n = s.vertices(); n < static_cast<int>(s.places.size()); ++n)
        if (!s.places[std::size_t(n)].empty())
            made += move(s, n);
    return made;
}

std::size_t reassign_pass(TaperState& s)
{
    std::size_t made = 0;
    for (int level = 1; level <= s.levels; ++level)
        for (int v = 0; v < s.vertices(); ++v) {
            const int place = level * s.vertices() + v;
            for (const int u : neighbours(*s.mesh, v)) {
                const int to = s.node_at(level, u);
                if (to != s.node[std::size_t(place)] && reassign(s, place, to))
                    ++made;
            }
        }
    return made;
}

std::size_t turn_pass(TaperState& s)
{
    std::size_t made = 0;
    for (int layer = 0; layer < s.levels; ++layer)
        for (int e = 0; e < static_cast<int>(s.edges.size()); ++e)
            made += turn(s, layer, e);
    return made;
}

} // namespace vdb_shell::taper
