// SPDX-License-Identifier: Apache-2.0

// Takes: a valid state. Leaves: a valid state that costs less, after one try of each change of a
// kind. Pairs of nodes are merged shortest first, as the edges of a surface are by a decimator:
// the shortest ones make the worst tets. One thread, in an order that depends on coordinates and
// indices only.

#include "taper/passes.h"

#include "growth/grow_state.h"
#include "taper/changes.h"
#include "taper/inner_contacts.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <tuple>
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

/// Asks for an interrupt every so many tries: one takes some ten microseconds.
class Tries
{
public:
    Tries(const StageProgress& progress, int percent) : progress_(progress), percent_(percent) {}
    void next()
    {
        constexpr unsigned kBetween = 1024;
        if (++tries_ % kBetween == 0)
            progress_.stop_if_interrupted(percent_);
    }

private:
    const StageProgress& progress_;
    int percent_;
    unsigned tries_ = 0;
};

} // namespace

std::size_t merge_pass(TaperState& s, const MergeOptions& options, const StageProgress& progress,
                       int percent)
{
    Changes changes(s);
    Tries tries(progress, percent);
    // What a node has become part of in this pass.
    std::vector<int> now(s.point.size());
    std::iota(now.begin(), now.end(), 0);
    const auto find = [&](int n) {
        while (now[std::size_t(n)] != n)
            n = now[std::size_t(n)];
        return n;
    };
    std::size_t made = 0;
    for (const Pair& pair : pairs_to_merge(s, options)) {
        tries.next();
        int from = find(pair.high), to = find(pair.low);
        if (from == to)
            continue;
        // Of two that can move the one with fewer places changes its name.
        if (s.fixed(from) ||
            (!s.fixed(to) && s.places[std::size_t(from)].size() > s.places[std::size_t(to)].size()))
            std::swap(from, to);
        if (s.fixed(from) || !changes.merge(from, to))
            continue;
        now[std::size_t(from)] = to;
        ++made;
    }
    rebuild_inner_tree(s);
    return made;
}

std::size_t move_pass(TaperState& s, const StageProgress& progress, int percent)
{
    Changes changes(s);
    Tries tries(progress, percent);
    std::size_t made = 0;
    for (int n = s.vertices(); n < static_cast<int>(s.point.size()); ++n) {
        tries.next();
        made += s.used(n) && changes.move(n);
    }
    rebuild_inner_tree(s);
    return made;
}

std::size_t hand_over_pass(TaperState& s, const StageProgress& progress, int percent)
{
    Changes changes(s);
    Tries tries(progress, percent);
    std::size_t made = 0;
    for (int level = 1; level <= s.levels; ++level)
        for (int v = 0; v < s.vertices(); ++v) {
            tries.next();
            const int place = s.place(level, v);
            for (const int u : neighbours(*s.mesh, v)) {
                const int from = s.node[std::size_t(place)], to = s.node_at(level, u);
                // Outer nodes have a place of their own, which no other node can take in.
                if (from != to && !s.fixed(from) && s.places[std::size_t(from)].size() > 1)
                    made += changes.hand_over(place, to);
            }
        }
    rebuild_inner_tree(s);
    return made;
}

std::size_t turn_pass(TaperState& s, const StageProgress& progress, int percent)
{
    Changes changes(s);
    Tries tries(progress, percent);
    std::size_t made = 0;
    for (int layer = 0; layer < s.levels; ++layer)
        for (int e = 0; e < static_cast<int>(s.edges.size()); ++e) {
            tries.next();
            made += changes.turn(layer, e);
        }
    return made;
}

} // namespace vdb_shell::taper
