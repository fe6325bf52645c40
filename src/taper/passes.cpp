// SPDX-License-Identifier: Apache-2.0

// Takes: a valid state. Leaves: a valid state that costs less, after one try of each change of a
// kind. Pairs of nodes are merged shortest first, as the edges of a surface are by a decimator:
// the shortest ones make the worst tets. The order depends on coordinates and indices only.

#include "taper/passes.h"

#include "core/parallel.h"
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

void add_pair(const TaperState& s, int p, int q, std::vector<Pair>& pairs)
{
    if (p != q && !(s.fixed(p) && s.fixed(q)))
        pairs.push_back({distance(s, p, q), std::min(p, q), std::max(p, q)});
}

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
    std::sort(pairs.begin(), pairs.end());
    pairs.erase(std::unique(pairs.begin(), pairs.end(),
                            [](const Pair& a, const Pair& b) {
                                return a.low == b.low && a.high == b.high;
                            }),
                pairs.end());
    return pairs;
}

// Before everything that has changed.
constexpr std::uint32_t kAlways = 0;

} // namespace

/// A block of changes is tried by all threads on the state as it is, without making any; then one
/// thread makes them in their order. It leaves out those that did not pay, unless a tet beside them
/// has changed since, and tries the others once more: they may also fail by the inner surface.
/// `make(item, then)` has to do nothing where nothing has changed since then.
template <class Item, class Trial, class Make>
std::size_t Passes::in_blocks(const std::vector<Item>& items, int percent, const Trial& trial,
                              const Make& make)
{
    // Long enough for two dozen threads, short enough that most of it is still true when its turn
    // comes.
    constexpr std::size_t kBlock = 256;
    std::vector<std::uint8_t> pays(kBlock);
    std::size_t made = 0;
    for (std::size_t begin = 0; begin < items.size(); begin += kBlock) {
        progress_.stop_if_interrupted(percent);
        const std::size_t count = std::min(kBlock, items.size() - begin);
        const std::uint32_t then = changes_.now();
        for_each_range(
            count,
            [&](std::size_t first, std::size_t last) {
                Trials& trials = trials_.local();
                for (std::size_t i = first; i < last; ++i)
                    pays[i] = trial(trials, items[begin + i]);
            },
            8);
        for (std::size_t i = 0; i < count; ++i)
            made += make(items[begin + i], pays[i] != 0 ? kAlways : then);
    }
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
    // What a node has become part of in this pass.
    std::vector<int> now(s.point.size());
    std::iota(now.begin(), now.end(), 0);
    const auto find = [&](int n) {
        while (now[std::size_t(n)] != n)
            n = now[std::size_t(n)];
        return n;
    };
    // Of two that can move the one with fewer places changes its name.
    const auto ends_of = [&](const Pair& pair) {
        int from = find(pair.high), to = find(pair.low);
        if (s.fixed(from) ||
            (!s.fixed(to) && s.places[std::size_t(from)].size() > s.places[std::size_t(to)].size()))
            std::swap(from, to);
        return std::array{from, to};
    };
    std::vector<Pair> pairs = pairs_to_merge(s, options_);
    pairs.erase(std::remove_if(pairs.begin(), pairs.end(),
                               [&](const Pair& p) { return !changed_since(p.low, p.high, last); }),
                pairs.end());
    const std::size_t made = in_blocks(
        pairs, percent,
        [&](Trials& trials, const Pair& pair) {
            const auto [from, to] = ends_of(pair);
            return from != to && !s.fixed(from) && trials.merge(from, to);
        },
        [&](const Pair& pair, std::uint32_t then) {
            const auto [from, to] = ends_of(pair);
            if (from == to || s.fixed(from) || !changed_since(from, to, then) ||
                !changes_.merge(from, to))
                return false;
            now[std::size_t(from)] = to;
            return true;
        });
    return renewed_after(made);
}

std::size_t Passes::move(int percent)
{
    TaperState& s = changes_.state();
    const std::uint32_t last = std::exchange(last_.move, changes_.now());
    std::vector<int> nodes;
    for (int n = s.vertices(); n < static_cast<int>(s.point.size()); ++n)
        if (s.used(n) && changes_.changed_since(n, last))
            nodes.push_back(n);
    const std::size_t made = in_blocks(
        nodes, percent, [](Trials& trials, int n) { return trials.move(n); },
        [&](int n, std::uint32_t then) {
            return changes_.changed_since(n, then) && changes_.move(n);
        });
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
    const auto may = [&](const Handed& h, std::uint32_t then) {
        const int from = s.node[std::size_t(h.place)], to = s.node[std::size_t(h.neighbour)];
        // Outer nodes have a place of their own, which no other node can take in.
        return from != to && !s.fixed(from) && s.places[std::size_t(from)].size() > 1 &&
               changed_since(from, to, then);
    };
    for (int level = 1; level <= s.levels; ++level)
        for (int v = 0; v < s.vertices(); ++v)
            for (const int u : neighbours(*s.mesh, v))
                if (const Handed h{s.place(level, v), s.place(level, u)}; may(h, last))
                    items.push_back(h);
    const std::size_t made = in_blocks(
        items, percent,
        [&](Trials& trials, const Handed& h) {
            return trials.hand_over(h.place, s.node[std::size_t(h.neighbour)]);
        },
        [&](const Handed& h, std::uint32_t then) {
            return may(h, then) && changes_.hand_over(h.place, s.node[std::size_t(h.neighbour)]);
        });
    return renewed_after(made);
}

std::size_t Passes::turn(int percent)
{
    const TaperState& s = changes_.state();
    std::size_t made = 0;
    for (int layer = 0; layer < s.levels; ++layer) {
        progress_.stop_if_interrupted(percent);
        for (int e = 0; e < static_cast<int>(s.edges.size()); ++e)
            made += changes_.turn(layer, e);
    }
    return made;
}

} // namespace vdb_shell::taper
