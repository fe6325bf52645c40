// SPDX-License-Identifier: Apache-2.0

// Takes: a valid state. Leaves: a valid state that costs less, after one try of each change of a
// kind. Pairs of nodes are merged shortest first, as the edges of a surface are by a decimator:
// the shortest ones make the worst tets. The order depends on coordinates and indices only.

#include "taper/passes.h"

#include "core/propose_in_blocks.h"
#include "core/stage_stop.h"
#include "growth/grow_state.h"
#include "taper/inner_contacts.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <tuple>
#include <utility>
#include <vector>

namespace vdb_shell::taper
{
namespace
{

struct Pair {
    double length;
    int low, high;
    bool operator<(const Pair& o) const
    {
        return std::tie(length, low, high) < std::tie(o.length, o.low, o.high);
    }
};

double distance(const TaperState& s, int p, int q)
{
    return (s.at(p) - s.at(q)).length();
}

/// Nothing where the two are one already, or where neither can move.
void add_pair(const TaperState& s, int p, int q, std::vector<Pair>& pairs)
{
    if (p != q && !(s.fixed(p) && s.fixed(q)))
        pairs.push_back({distance(s, p, q), std::min(p, q), std::max(p, q)});
}

/// What a node has become part of in a pass of merges. Pairs keep the names of before it.
class NamesInPass
{
public:
    explicit NamesInPass(const TaperState& s) : s_(s), now_(s.point.size())
    {
        std::iota(now_.begin(), now_.end(), 0);
    }
    void join(int from, int to) { now_[std::size_t(from)] = to; }
    /// The nodes that the pair is now: the one that changes its name, and the one that keeps it. Of
    /// two that can move the one with fewer places changes it.
    std::array<int, 2> ends_of(const Pair& pair) const
    {
        const int from = name_of(pair.high), to = name_of(pair.low);
        if (s_.fixed(from) || (!s_.fixed(to) && places_of(from) > places_of(to)))
            return {to, from};
        return {from, to};
    }

private:
    int name_of(int n) const
    {
        while (now_[std::size_t(n)] != n)
            n = now_[std::size_t(n)];
        return n;
    }
    std::size_t places_of(int n) const { return s_.places[std::size_t(n)].size(); }

    const TaperState& s_;
    std::vector<int> now_;
};

/// To the nearest neighbour on the innermost surface.
double nearest_neighbour(const TaperState& s, int n)
{
    double nearest = std::numeric_limits<double>::infinity();
    for (const int place : s.places[std::size_t(n)])
        if (s.level_of(place) == s.levels)
            for (const int u : neighbours(*s.mesh, s.vertex_of(place)))
                if (const int other = s.node_at(s.levels, u); other != n)
                    nearest = std::min(nearest, distance(s, n, other));
    return nearest;
}

void add_pairs_across(const TaperState& s, double share, std::vector<Pair>& pairs)
{
    for (int n = s.vertices(); n < static_cast<int>(s.point.size()); ++n) {
        if (!s.on_inner_surface(n))
            continue;
        const double reach = share * nearest_neighbour(s, n);
        // Without a neighbour on the innermost surface there is no length to measure a gap by.
        if (!std::isfinite(reach))
            continue;
        FloatBox box = FloatBox::around(Vec3s(s.at(n) - Vec3d(reach)));
        box.add(Vec3s(s.at(n) + Vec3d(reach)));
        s.inner_tree.for_each_overlap(box, [&](int face) {
            for (int i = 0; i < 3; ++i)
                if (const int m = s.corner(s.levels, face, i);
                    !s.obstacle(m) && distance(s, n, m) <= reach)
                    add_pair(s, n, m, pairs);
        });
    }
}

std::vector<Pair> pairs_to_merge(const TaperState& s, const MergeOptions& options)
{
    std::vector<Pair> pairs;
    for (int level = 1; level <= s.levels; ++level) {
        for (const auto& edge : s.edges)
            add_pair(s, s.node_at(level, edge[0]), s.node_at(level, edge[1]), pairs);
        for (int v = 0; options.into_level_above && v < s.vertices(); ++v)
            add_pair(s, s.node_at(level, v), s.node_at(level - 1, v), pairs);
    }
    if (options.across > 0)
        add_pairs_across(s, options.across, pairs);
    // Pairs that come from several edges, or from an edge and across the void, have equal lengths
    // and are neighbours then.
    std::sort(pairs.begin(), pairs.end());
    pairs.erase(std::unique(pairs.begin(), pairs.end(),
                            [](const Pair& a, const Pair& b) {
                                return a.low == b.low && a.high == b.high;
                            }),
                pairs.end());
    return pairs;
}

} // namespace

/// A block of changes is tried by all threads on the state as it is, without making any; then one
/// thread makes those that pay in their order, if the inner surface allows it, and tries a change
/// once more if a tet beside it has changed since.
///
/// search(trials, item): whether it pays; stale(item, then): whether a tet beside it has changed;
/// make(item, trial): makes what was found; again(item): tries it and makes it.
template <class Item, class Search, class Stale, class Make, class Again>
std::size_t Passes::in_blocks(const std::vector<Item>& items, int percent, const Search& search,
                              const Stale& stale, const Make& make, const Again& again)
{
    // Long enough for two dozen threads, short enough that most of it is still true when its turn
    // comes.
    constexpr std::size_t kBlock = 256;
    std::vector<Trial> found(kBlock);
    std::vector<std::uint8_t> pays(kBlock);
    std::uint32_t then = 0;
    std::size_t made = 0;
    propose_in_blocks(
        items.size(), kBlock,
        [&] {
            progress_.stop_if_interrupted(percent);
            then = changes_.now();
        },
        [&](std::size_t i, std::size_t slot) {
            Trials& trials = trials_.local();
            pays[slot] = search(trials, items[i]);
            if (pays[slot] != 0)
                trials.give(found[slot]);
        },
        [&](std::size_t i, std::size_t slot) {
            if (stale(items[i], then))
                made += again(items[i]);
            else if (pays[slot] != 0)
                made += make(items[i], found[slot]);
        });
    return made;
}

/// The tree of the inner surface is built anew where boxes have been widened often enough to make
/// up for it.
std::size_t Passes::renewed_after(std::size_t made)
{
    constexpr std::size_t kFacesToAChange = 64;
    TaperState& s = changes_.state();
    if ((widened_ += made) * kFacesToAChange > std::size_t(s.faces())) {
        rebuild_inner_tree(s);
        widened_ = 0;
    }
    return made;
}

std::size_t Passes::merge(int percent)
{
    TaperState& s = changes_.state();
    const std::uint32_t last = std::exchange(last_.merge, changes_.now());
    NamesInPass names(s);
    std::vector<Pair> pairs = pairs_to_merge(s, options_);
    pairs.erase(std::remove_if(pairs.begin(), pairs.end(),
                               [&](const Pair& p) { return !changed_since(p.low, p.high, last); }),
                pairs.end());
    const auto joined = [&](int from, int to, bool made) {
        if (made)
            names.join(from, to);
        return made;
    };
    const std::size_t made = in_blocks(
        pairs, percent,
        [&](Trials& trials, const Pair& pair) {
            const auto [from, to] = names.ends_of(pair);
            return from != to && !s.fixed(from) && trials.merge(from, to);
        },
        [&](const Pair& pair, std::uint32_t then) {
            const auto [from, to] = names.ends_of(pair);
            return changed_since(from, to, then);
        },
        [&](const Pair&, Trial& trial) {
            return joined(trial.change.from, trial.change.to, changes_.make_merge(trial));
        },
        [&](const Pair& pair) {
            const auto [from, to] = names.ends_of(pair);
            return from != to && !s.fixed(from) && joined(from, to, changes_.merge(from, to));
        });
    return renewed_after(made);
}

std::size_t Passes::move(int percent)
{
    TaperState& s = changes_.state();
    const std::uint32_t last = std::exchange(last_.move, changes_.now());
    // Outer points, which come first, stay where they are; a node whose places have gone over to
    // others is not there any more.
    std::vector<int> nodes;
    for (int n = s.vertices(); n < static_cast<int>(s.point.size()); ++n)
        if (s.used(n) && changes_.changed_since(n, last))
            nodes.push_back(n);
    const std::size_t made = in_blocks(
        nodes, percent, [](Trials& trials, int n) { return trials.move(n); },
        [&](int n, std::uint32_t then) { return changes_.changed_since(n, then); },
        [&](int, Trial& trial) { return changes_.make_move(trial); },
        [&](int n) { return changes_.move(n); });
    return renewed_after(made);
}

std::size_t Passes::hand_over(int percent)
{
    TaperState& s = changes_.state();
    const std::uint32_t last = std::exchange(last_.hand_over, changes_.now());
    struct Handed {
        int place, neighbour;
    };
    std::vector<Handed> items;
    const auto from = [&](const Handed& h) { return s.node[std::size_t(h.place)]; };
    const auto to = [&](const Handed& h) { return s.node[std::size_t(h.neighbour)]; };
    // Outer nodes have a place of their own, which no other node can take in.
    const auto may = [&](const Handed& h) {
        return from(h) != to(h) && !s.fixed(from(h)) && s.places[std::size_t(from(h))].size() > 1;
    };
    for (int level = 1; level <= s.levels; ++level)
        for (int v = 0; v < s.vertices(); ++v)
            for (const int u : neighbours(*s.mesh, v))
                if (const Handed h{s.place(level, v), s.place(level, u)};
                    may(h) && changed_since(from(h), to(h), last))
                    items.push_back(h);
    const std::size_t made = in_blocks(
        items, percent,
        [&](Trials& trials, const Handed& h) { return may(h) && trials.hand_over(h.place, to(h)); },
        [&](const Handed& h, std::uint32_t then) { return changed_since(from(h), to(h), then); },
        [&](const Handed&, Trial& trial) { return changes_.make_hand_over(trial); },
        [&](const Handed& h) { return may(h) && changes_.hand_over(h.place, to(h)); });
    return renewed_after(made);
}

std::size_t Passes::turn(int percent)
{
    // By one thread, as a diagonal is turned in the state itself to be looked at.
    const TaperState& s = changes_.state();
    std::size_t made = 0;
    for (int layer = 0; layer < s.levels; ++layer) {
        progress_.stop_if_interrupted(percent);
        for (std::size_t e = 0; e < s.edges.size(); ++e) {
            stop_if_stage_wants(e);
            made += changes_.turn(layer, static_cast<int>(e));
        }
    }
    return made;
}

} // namespace vdb_shell::taper
