// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/box_tree.h"
#include "core/pair_bounds.h"
#include "core/parallel.h"
#include "core/polled_stop.h"
#include "core/unit_vector.h"

#include <openvdb/Types.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

namespace vdb_shell
{

/// Corners of a flat part; fewer than four are there several times.
using FlatCorners = std::array<openvdb::Vec3d, 4>;

inline openvdb::Vec3d normal_of(const FlatCorners& c)
{
    return unit_vector((c[1] - c[0]).cross(c[2] - c[0]));
}

/// The largest float that is not above x.
inline float float_below(double x)
{
    return std::nextafter(float(x), -std::numeric_limits<float>::infinity());
}

/// Pairs of flat parts that lie close to many others and do not meet them, as layers do, however
/// they are cut: each is bounded along as many directions as there are normals among them, up to a
/// few dozen, so two layers are apart along the normal of one, whichever way they lie (Klosowski
/// et al., 1998, with directions of the data). A tree over such bounds is walked against itself. A
/// Piece is as in core/crowded_pairs.h, each of another item.
template <class Piece> class LayeredPairs
{
public:
    LayeredPairs(std::vector<Piece> pieces, const PairBounds& wanted, const PolledStop& stop)
        : pieces_(std::move(pieces)), wanted_(wanted), stop_(stop), order_(pieces_.size()),
          bounds_(pieces_.size()), leaf_of_(pieces_.size())
    {
        choose_directions();
        for_each_index(pieces_.size(), [&](std::size_t i) {
            order_[i] = std::uint32_t(i);
            bounds_[i] = bounds_of(pieces_[i]);
        });
        if (!order_.empty())
            add_node(0, order_.size(), 0);
        if (wanted_.settled)
            count_unsettled();
    }

    /// Appends the pairs i < j of items for which keep(i, j) holds, called from several threads.
    /// False if there are more of them than are wanted; then not all are there.
    template <class Keep>
    bool list(const Keep& keep, std::vector<std::array<std::uint32_t, 2>>& pairs)
    {
        if (order_.empty())
            return true;
        // Enough parts of the walk for any number of threads.
        constexpr std::size_t kParts = 512;
        std::vector<NodePair> parts{{0, 0}}, next;
        for (int level = 0; level < 12 && parts.size() < kParts; ++level) {
            next.clear();
            for (const NodePair& both : parts)
                look(both, next, [&](std::uint32_t, std::uint32_t) { next.push_back(both); });
            std::swap(parts, next);
        }
        // So many parts at a time as seem to have no more than is left, each to that at most: so
        // what is found does not depend on threads.
        const std::size_t most = wanted_.most_of(pieces_.size());
        std::size_t at_once = most == SIZE_MAX ? parts.size() : 1;
        for (std::size_t begin = 0, end = 0; begin < parts.size() && pairs.size() < most;
             begin = end) {
            end = std::min(begin + at_once, parts.size());
            std::vector<std::vector<std::array<std::uint32_t, 2>>> found(end - begin);
            const std::size_t left = most - pairs.size();
            for_each_index(
                found.size(), [&](std::size_t i) { walk(parts[begin + i], keep, left, found[i]); },
                1);
            std::size_t largest = 1;
            for (const auto& some : found) {
                pairs.insert(pairs.end(), some.begin(), some.end());
                largest = std::max(largest, some.size());
            }
            at_once = std::clamp<std::size_t>(left / largest, 1, 2 * at_once);
        }
        return pairs.size() < most;
    }

private:
    static constexpr std::size_t kDirections = 32;
    struct Bounds {
        std::array<float, kDirections> low, high;

        void add(const Bounds& o)
        {
            for (std::size_t k = 0; k < kDirections; ++k)
                low[k] = std::min(low[k], o.low[k]), high[k] = std::max(high[k], o.high[k]);
        }
        /// All directions without a branch: many at a time.
        bool apart(const Bounds& o) const
        {
            unsigned any = 0;
            for (std::size_t k = 0; k < kDirections; ++k)
                any |= unsigned(low[k] > o.high[k]) | unsigned(o.low[k] > high[k]);
            return any != 0;
        }
        std::size_t widest() const
        {
            std::size_t best = 0;
            for (std::size_t k = 1; k < kDirections; ++k)
                if (high[k] - low[k] > high[best] - low[best])
                    best = k;
            return best;
        }
    };
    struct Node {
        Bounds bounds;
        float width;
        BoxTree::Marks common;              ///< that all pieces in it carry
        std::uint32_t piece;                ///< of a leaf
        std::array<std::uint32_t, 2> child; ///< both 0: it is a leaf
        std::uint32_t parent;               ///< of the root: itself
    };
    using NodePair = std::array<std::uint32_t, 2>;

    /// The axes, and then again and again the normal that is farthest from all before it.
    void choose_directions()
    {
        std::vector<openvdb::Vec3d> normals(pieces_.size());
        std::vector<double> nearest(pieces_.size(), 0.0); // squared cosine
        for_each_index(normals.size(),
                       [&](std::size_t i) { normals[i] = normal_of(pieces_[i].corners()); });
        direction_.fill(openvdb::Vec3d(0.0));
        for (std::size_t k = 0; k < kDirections && !stop_.wanted(); ++k) {
            if (k < 3)
                direction_[k][int(k)] = 1;
            else {
                const auto far = std::min_element(nearest.begin(), nearest.end());
                if (far == nearest.end() || *far > 1 - 1e-6)
                    return; // the rest bounds nothing, and parts nothing
                direction_[k] = normals[std::size_t(far - nearest.begin())];
            }
            for_each_index(normals.size(), [&](std::size_t i) {
                const double cosine = normals[i].dot(direction_[k]);
                const bool none = normals[i].lengthSqr() == 0;
                nearest[i] = none ? 1 : std::max(nearest[i], cosine * cosine);
            });
        }
    }
    Bounds bounds_of(const Piece& piece) const
    {
        Bounds bounds;
        const FlatCorners corners = piece.corners();
        for (std::size_t k = 0; k < kDirections; ++k) {
            double low = std::numeric_limits<double>::infinity(), high = -low;
            for (const openvdb::Vec3d& p : corners) {
                const double at = direction_[k].dot(p);
                low = std::min(low, at), high = std::max(high, at);
            }
            bounds.low[k] = float_below(low - piece.pad);
            bounds.high[k] = -float_below(-high - piece.pad);
        }
        return bounds;
    }

    std::uint32_t add_node(std::size_t begin, std::size_t end, std::uint32_t parent)
    {
        Node node{bounds_[order_[begin]], 0,      common_marks(begin, end),
                  order_[begin],          {0, 0}, parent};
        for (std::size_t i = begin + 1; i < end; ++i)
            node.bounds.add(bounds_[order_[i]]);
        const std::size_t widest = node.bounds.widest();
        node.width = node.bounds.high[widest] - node.bounds.low[widest];
        const auto at = std::uint32_t(nodes_.size());
        nodes_.push_back(node);
        if (end - begin == 1) {
            leaf_of_[order_[begin]] = at;
            return at;
        }
        const std::size_t middle = begin + (end - begin) / 2;
        const auto place = [&](std::size_t i) { return order_.begin() + std::ptrdiff_t(i); };
        std::nth_element(place(begin), place(middle), place(end),
                         [&](std::uint32_t a, std::uint32_t b) {
                             const float x = bounds_[a].low[widest] + bounds_[a].high[widest],
                                         y = bounds_[b].low[widest] + bounds_[b].high[widest];
                             return x != y ? x < y : a < b;
                         });
        const std::uint32_t low = add_node(begin, middle, at), high = add_node(middle, end, at);
        nodes_[at].child = {low, high};
        return at;
    }
    BoxTree::Marks common_marks(std::size_t begin, std::size_t end) const
    {
        BoxTree::Marks common = pieces_[order_[begin]].marks;
        for (std::size_t i = begin + 1; i < end; ++i)
            for (std::uint32_t& mark : common)
                if (!BoxTree::have_common({mark, BoxTree::kNoMark, BoxTree::kNoMark},
                                          pieces_[order_[i]].marks))
                    mark = BoxTree::kNoMark;
        return common;
    }

    void count_unsettled()
    {
        unsettled_ = std::vector<std::atomic<std::uint32_t>>(nodes_.size());
        told_ = std::vector<std::atomic<bool>>(pieces_.size());
        for (std::size_t n = nodes_.size(); n-- > 0;)
            unsettled_[n] = is_leaf(std::uint32_t(n))
                                ? 1
                                : unsettled_[nodes_[n].child[0]] + unsettled_[nodes_[n].child[1]];
        for (std::uint32_t p = 0; p < pieces_.size(); ++p)
            note_if_settled(p);
    }
    /// Whether nothing is asked about two pieces of these nodes.
    bool settled(std::uint32_t a, std::uint32_t b) const
    {
        return !unsettled_.empty() && unsettled_[a].load(std::memory_order_relaxed) == 0 &&
               unsettled_[b].load(std::memory_order_relaxed) == 0;
    }
    void note_if_settled(std::uint32_t piece)
    {
        if (unsettled_.empty() || told_[piece].load(std::memory_order_relaxed) ||
            !wanted_.settled(pieces_[piece].item) || told_[piece].exchange(true))
            return;
        std::uint32_t at = leaf_of_[piece];
        for (; at != nodes_[at].parent; at = nodes_[at].parent)
            unsettled_[at].fetch_sub(1, std::memory_order_relaxed);
        unsettled_[at].fetch_sub(1, std::memory_order_relaxed);
    }

    bool is_leaf(std::uint32_t node) const { return nodes_[node].child[1] == 0; }
    /// Adds what has to be looked at next, or calls meet with two pieces.
    template <class Meet>
    void look(const NodePair& both, std::vector<NodePair>& next, const Meet& meet) const
    {
        const auto [a, b] = both;
        const Node &first = nodes_[a], &second = nodes_[b];
        if (settled(a, b))
            return;
        if (a == b) {
            const auto [low, high] = first.child;
            if (!is_leaf(a))
                next.insert(next.end(), {{low, low}, {high, high}, {low, high}});
            return;
        }
        if (first.bounds.apart(second.bounds) || BoxTree::have_common(first.common, second.common))
            return;
        if (is_leaf(a) && is_leaf(b))
            return meet(first.piece, second.piece);
        const bool part_first = !is_leaf(a) && (is_leaf(b) || first.width > second.width);
        for (const std::uint32_t child : (part_first ? first : second).child)
            next.push_back(part_first ? NodePair{child, b} : NodePair{a, child});
    }
    template <class Keep>
    void walk(const NodePair& from, const Keep& keep, std::size_t most,
              std::vector<std::array<std::uint32_t, 2>>& pairs)
    {
        std::vector<NodePair> open{from};
        while (!open.empty() && pairs.size() < most && !stop_.wanted()) {
            const NodePair both = open.back();
            open.pop_back();
            look(both, open, [&](std::uint32_t p, std::uint32_t q) {
                const auto [low, high] = std::minmax(pieces_[p].item, pieces_[q].item);
                if (!pieces_[p].surely_apart(pieces_[q]) && keep(low, high))
                    pairs.push_back({low, high});
                note_if_settled(p);
                note_if_settled(q);
            });
        }
    }

    std::vector<Piece> pieces_;
    const PairBounds& wanted_;
    const PolledStop& stop_;
    std::array<openvdb::Vec3d, kDirections> direction_;
    std::vector<std::uint32_t> order_; ///< of the pieces
    std::vector<Bounds> bounds_;       ///< of the pieces
    std::vector<Node> nodes_;
    std::vector<std::uint32_t> leaf_of_; ///< by piece
    /// By node, how many of its pieces are not settled, if that is wanted; by piece, whether it has
    /// been counted as settled.
    std::vector<std::atomic<std::uint32_t>> unsettled_;
    std::vector<std::atomic<bool>> told_;
};

} // namespace vdb_shell
