// SPDX-License-Identifier: Apache-2.0

// Takes: triangles and a seed. Gives: an order of the corners of each prism, chosen at random where
// there is a choice. Based on Erleben, Dohlmann, "The Thin Shell Tetrahedral Mesh", 2004, as the
// line-stepping paper and later readers describe it: each prism has one bit a side, "rising" or
// "falling"; neighbours have complementary bits across their common edge; all three alike cannot be
// split into tets. It is here for comparison: a conflict is passed on from prism to prism, and
// nothing proves that this ends, so the number of passes is bounded. One thread does it all, since
// each choice depends on those before; the result depends on the seed only.

#include "shell/ripple.h"

#include "core/counter_random.h"
#include "mesh/topology.h"
#include "vdb_shell/core/error.h"

#include <array>
#include <cassert>
#include <string>

namespace vdb_shell
{
namespace
{

using Three = std::array<std::uint32_t, 3>;

/// The bits are kept once per edge, as the corner that comes first. So neighbours cannot disagree,
/// and only prisms with a cycle (the bits 000 and 111) remain to be avoided.
enum class Arc : std::uint8_t { unset, from_smaller, from_larger };

struct Sides {
    std::vector<Three> edge;           ///< per triangle and side
    EdgeUses uses;                     ///< by edge
    std::vector<std::uint32_t> offset; ///< uses of edge e stand at [offset[e], offset[e+1])
};

Sides sides_of(const std::vector<openvdb::Vec3I>& triangles)
{
    Sides sides;
    sides.uses = sorted_edge_uses(triangles);
    sides.edge.resize(triangles.size());
    for (std::size_t i = 0; i < sides.uses.size(); ++i) {
        if (i == 0 || sides.uses[i].edge != sides.uses[i - 1].edge)
            sides.offset.push_back(static_cast<std::uint32_t>(i));
        const EdgeUse& use = sides.uses[i];
        sides.edge[use.triangle][use.side] = static_cast<std::uint32_t>(sides.offset.size() - 1);
    }
    sides.offset.push_back(static_cast<std::uint32_t>(sides.uses.size()));
    return sides;
}

class Ripple
{
public:
    Ripple(const std::vector<openvdb::Vec3I>& triangles, std::uint64_t seed)
        : triangles_(triangles), sides_(sides_of(triangles)), random_(seed),
          arcs_(sides_.offset.size() - 1, Arc::unset)
    {
    }

    PrismSplit run()
    {
        std::vector<std::uint8_t> seen(triangles_.size(), 0);
        for (std::uint32_t t = 0; t < triangles_.size(); ++t)
            if (!seen[t])
                spread_from(t, seen);
        PrismSplit split;
        split.ripples = ripples_;
        split.order.reserve(triangles_.size());
        for (std::uint32_t t = 0; t < triangles_.size(); ++t)
            split.order.push_back(order_of(t));
        return split;
    }

private:
    /// Whether the side's first corner comes before its second.
    bool rising(std::uint32_t triangle, std::size_t side) const
    {
        const openvdb::Vec3I& t = triangles_[triangle];
        const bool forward = t[static_cast<int>(side)] < t[static_cast<int>((side + 1) % 3)];
        return (arcs_[sides_.edge[triangle][side]] == Arc::from_smaller) == forward;
    }

    void set_rising(std::uint32_t triangle, std::size_t side, bool value)
    {
        const openvdb::Vec3I& t = triangles_[triangle];
        const bool forward = t[static_cast<int>(side)] < t[static_cast<int>((side + 1) % 3)];
        arcs_[sides_.edge[triangle][side]] =
            value == forward ? Arc::from_smaller : Arc::from_larger;
    }

    void flip(std::uint32_t edge)
    {
        arcs_[edge] = arcs_[edge] == Arc::from_smaller ? Arc::from_larger : Arc::from_smaller;
    }

    bool cyclic(std::uint32_t triangle) const
    {
        const bool first = rising(triangle, 0);
        return rising(triangle, 1) == first && rising(triangle, 2) == first;
    }

    std::uint64_t choose(std::uint64_t count) { return random_.below(draws_++, count); }

    /// Breadth first over the triangle's component, neighbours in the order of the sides and of the
    /// uses, which are sorted: so the order of the draws is the same on every machine.
    void spread_from(std::uint32_t start, std::vector<std::uint8_t>& seen)
    {
        std::vector<std::uint32_t> queue{start};
        seen[start] = 1;
        for (std::size_t next = 0; next < queue.size(); ++next) {
            const std::uint32_t t = queue[next];
            choose_code(t);
            for (const std::uint32_t edge : sides_.edge[t])
                for (std::uint32_t u = sides_.offset[edge]; u < sides_.offset[edge + 1]; ++u) {
                    const std::uint32_t neighbour = sides_.uses[u].triangle;
                    if (seen[neighbour])
                        continue;
                    seen[neighbour] = 1;
                    queue.push_back(neighbour);
                }
        }
    }

    /// One of the legal codes that agree with the sides that visited neighbours have fixed. A side
    /// that is open can always be set to differ from another, so there is no legal code only where
    /// all three sides are fixed and alike; that conflict is passed on.
    void choose_code(std::uint32_t triangle)
    {
        std::array<bool, 3> open{};
        for (std::size_t side = 0; side < 3; ++side)
            open[side] = arcs_[sides_.edge[triangle][side]] == Arc::unset;
        std::array<unsigned, 6> legal{};
        std::size_t count = 0;
        // Bit i of a code is side i; the codes 0 and 7 are the two cycles.
        for (unsigned code = 1; code < 7; ++code) {
            bool fits = true;
            for (std::size_t side = 0; side < 3; ++side)
                fits = fits && (open[side] || rising(triangle, side) == bool(code >> side & 1U));
            if (fits)
                legal[count++] = code;
        }
        if (count == 0) {
            flip_until_acyclic(triangle);
            return;
        }
        const unsigned code = legal[choose(count)];
        for (std::size_t side = 0; side < 3; ++side)
            if (open[side])
                set_rising(triangle, side, code >> side & 1U);
    }

    /// Whether flipping the edge would make a triangle other than `triangle` cyclic. A triangle
    /// with an open side cannot be, as its open sides are set later to suit the others.
    bool flip_harms(std::uint32_t edge, std::uint32_t triangle)
    {
        flip(edge);
        bool harm = false;
        for (std::uint32_t u = sides_.offset[edge]; u < sides_.offset[edge + 1]; ++u)
            harm = harm || (sides_.uses[u].triangle != triangle &&
                            is_set(sides_.uses[u].triangle) && cyclic(sides_.uses[u].triangle));
        flip(edge);
        return harm;
    }

    bool is_set(std::uint32_t triangle) const
    {
        for (const std::uint32_t edge : sides_.edge[triangle])
            if (arcs_[edge] == Arc::unset)
                return false;
        return true;
    }

    /// Flips sides until no triangle with all its sides set is cyclic, starting at one that is. A
    /// flip mends the triangle at hand, since two equal bits and a different one are no cycle, and
    /// can spoil only those beside the edge, so the list holds every triangle that may be cyclic.
    void flip_until_acyclic(std::uint32_t start)
    {
        struct Conflict {
            std::uint32_t triangle, entered_by;
        };
        constexpr std::uint32_t kNowhere = ~std::uint32_t(0);
        std::vector<Conflict> conflicts{{start, kNowhere}};
        while (!conflicts.empty()) {
            const Conflict here = conflicts.back();
            conflicts.pop_back();
            // A later flip may have mended a triangle that waits in the list.
            if (!cyclic(here.triangle))
                continue;
            const std::uint32_t edge = way_out(here.triangle, here.entered_by);
            flip(edge);
            for (std::uint32_t u = sides_.offset[edge]; u < sides_.offset[edge + 1]; ++u) {
                const std::uint32_t other = sides_.uses[u].triangle;
                if (other == here.triangle || !is_set(other) || !cyclic(other))
                    continue;
                count_ripple();
                conflicts.push_back({other, edge});
            }
        }
    }

    /// A side that can be flipped without harm, at random; else any side but the one that the
    /// ripple came by, whose flip would only undo the last.
    std::uint32_t way_out(std::uint32_t triangle, std::uint32_t entered_by)
    {
        Three harmless{}, onward{};
        std::size_t harmless_count = 0, onward_count = 0;
        for (const std::uint32_t edge : sides_.edge[triangle]) {
            if (edge == entered_by)
                continue;
            onward[onward_count++] = edge;
            if (!flip_harms(edge, triangle))
                harmless[harmless_count++] = edge;
        }
        return harmless_count > 0 ? harmless[choose(harmless_count)] : onward[choose(onward_count)];
    }

    void count_ripple()
    {
        // A conflict walks at random over the surface and ends at the first triangle where a flip
        // does no harm, which takes a few steps as a rule. The bound is far beyond that; it is
        // there because the method has no proof that it ends.
        const std::size_t most = 1000 + 100 * triangles_.size();
        if (++ripples_ > most)
            throw GeometryError("ripple split: still inconsistent after passing on " +
                                std::to_string(most) + " conflicts over " +
                                std::to_string(triangles_.size()) +
                                " triangles; choose another seed or another split rule");
    }

    std::array<std::uint8_t, 3> order_of(std::uint32_t triangle) const
    {
        assert(!cyclic(triangle));
        std::array<std::uint8_t, 3> order{};
        for (std::uint8_t corner = 0; corner < 3; ++corner) {
            // The place of a corner is the number of corners before it, which is a permutation
            // because there is no cycle.
            const bool after_last = rising(triangle, (corner + 2U) % 3);
            const bool after_next = !rising(triangle, corner);
            order[static_cast<std::size_t>(after_last) + static_cast<std::size_t>(after_next)] =
                corner;
        }
        return order;
    }

    const std::vector<openvdb::Vec3I>& triangles_;
    Sides sides_;
    CounterRandom random_;
    std::vector<Arc> arcs_;
    std::uint64_t draws_ = 0;
    std::size_t ripples_ = 0;
};

} // namespace

PrismSplit ripple_split(const std::vector<openvdb::Vec3I>& triangles, std::uint64_t seed)
{
    if (triangles.empty())
        return {};
    return Ripple(triangles, seed).run();
}

} // namespace vdb_shell
