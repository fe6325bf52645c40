// SPDX-License-Identifier: Apache-2.0

// Takes: a valid state and one change. Leaves: a valid state that costs less, or the state as it
// was. The tests are those of docs/theory.md, "Tapered shells": tets positive, inner triangles
// without contacts, no part of the inner surface passed; those that look at tets alone come first,
// as most changes fail by them.

#include "taper/changes.h"

#include <algorithm>
#include <array>

namespace vdb_shell::taper
{

using growth::FaceCorner;

void Changes::accept(const Trial& trial)
{
    ++now_;
    for (std::size_t i = 0; i < trial.pieces.size(); ++i) {
        const int piece = trial.pieces[i];
        s_.cost[std::size_t(piece)] = trial.costs[i];
        // All nodes of the pieces and not only the one that moved: any of their tets may pay for a
        // change now that did not before.
        for (const int n : nodes_of(s_, piece))
            changed_[std::size_t(n)] = now_;
    }
    update_inner_tree(s_, trial.pieces);
}

/// Tells the places of node `from` that they belong to `to`, without telling `to`.
void Changes::point_places(int from, int to)
{
    for (const int place : s_.places[std::size_t(from)])
        s_.node[std::size_t(place)] = to;
}

/// Asked after the change.
bool Changes::inner_surface_allows(const Trial& trial)
{
    const Substitution& change = trial.change;
    for (Swept& tet : swept_)
        tet.corners[3] = change.at;
    return !passes_itself(s_, swept_, trial.pieces, {change.from, change.to}) &&
           inner_triangles_clear(s_, trial.pieces);
}

bool Changes::make_merge(Trial& trial)
{
    const int from = trial.change.from, to = trial.change.to;
    swept_.clear();
    // Before the change, as what is swept over begins at the old triangles.
    list_swept(s_, trial.pieces, from, swept_);
    const auto of_from = std::ptrdiff_t(swept_.size());
    list_swept(s_, trial.pieces, to, swept_);
    // A triangle that has both is swept over once.
    swept_.erase(std::remove_if(swept_.begin() + of_from, swept_.end(),
                                [from](const Swept& t) {
                                    return t.nodes[0] == from || t.nodes[1] == from ||
                                           t.nodes[2] == from;
                                }),
                 swept_.end());
    const Vec3d before = s_.at(to);
    // The state is changed first and asked then: contacts and passing are of triangles as they are
    // after it.
    point_places(from, to);
    s_.point[std::size_t(to)] = trial.change.at;
    if (!inner_surface_allows(trial)) {
        // `places` of the two nodes has not been touched yet, so it still says which were whose.
        point_places(from, from);
        s_.point[std::size_t(to)] = before;
        return false;
    }
    auto &places_from = s_.places[std::size_t(from)], &places_to = s_.places[std::size_t(to)];
    const auto middle = std::ptrdiff_t(places_to.size());
    places_to.insert(places_to.end(), places_from.begin(), places_from.end());
    // Ascending, which on_inner_surface relies on: the last place says the deepest level.
    std::inplace_merge(places_to.begin(), places_to.begin() + middle, places_to.end());
    places_from.clear();
    accept(trial);
    return true;
}

bool Changes::make_move(Trial& trial)
{
    const int n = trial.change.to;
    swept_.clear();
    list_swept(s_, trial.pieces, n, swept_);
    const Vec3d here = s_.at(n);
    // The inner surface knows nothing of the step's share, so it is asked again for each shorter
    // one.
    for (bool passes = true; passes;) {
        s_.point[std::size_t(n)] = trial.change.at;
        if (inner_surface_allows(trial)) {
            accept(trial);
            return true;
        }
        s_.point[std::size_t(n)] = here;
        passes = trials_.move_less(trial);
        if (passes)
            trials_.give(trial);
    }
    return false;
}

void Changes::list_swept_by_place(int place, int to)
{
    swept_.clear();
    // Only the innermost surface can be passed; places above it bound no void.
    if (s_.level_of(place) != s_.levels)
        return;
    const int from = s_.node[std::size_t(place)];
    for (const FaceCorner& at : star(*s_.mesh, s_.vertex_of(place))) {
        const int p = s_.corner(s_.levels, at.face, (at.local + 1) % 3),
                  q = s_.corner(s_.levels, at.face, (at.local + 2) % 3);
        // A triangle that has lost its area, or that the change takes it from, sweeps over nothing.
        if (p != q && p != from && q != from && p != to && q != to)
            swept_.push_back({{from, p, q}, {s_.at(from), s_.at(p), s_.at(q), s_.at(to)}});
    }
}

bool Changes::make_hand_over(Trial& trial)
{
    const int place = trial.change.place, to = trial.change.to;
    list_swept_by_place(place, to);
    const int from = s_.node[std::size_t(place)];
    s_.node[std::size_t(place)] = to;
    if (!inner_surface_allows(trial)) {
        s_.node[std::size_t(place)] = from;
        return false;
    }
    auto& left = s_.places[std::size_t(from)];
    left.erase(std::find(left.begin(), left.end(), place));
    auto& joined = s_.places[std::size_t(to)];
    joined.insert(std::upper_bound(joined.begin(), joined.end(), place), place);
    accept(trial);
    return true;
}

bool Changes::turn(int layer, int edge)
{
    const auto& faces = s_.faces_of_edge[std::size_t(edge)];
    const int first = layer * s_.faces();
    trials_.list(faces[0] == faces[1] ? std::vector<int>{first + faces[0]}
                                      : std::vector<int>{first + faces[0], first + faces[1]});
    std::uint8_t& diagonal = s_.diagonal_of(layer, edge);
    diagonal ^= 1U;
    // A diagonal lies in the quad between two surfaces and moves no triangle of either, so nothing
    // is asked of the inner one.
    if (trials_.turned_costs_less()) {
        accept(own_trial());
        return true;
    }
    diagonal ^= 1U;
    return false;
}

} // namespace vdb_shell::taper
