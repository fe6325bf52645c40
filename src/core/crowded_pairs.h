// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/box_tree.h"
#include "core/parallel.h"
#include "core/polled_stop.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

namespace vdb_shell
{

/// A box with room for the rounding of doubles around it.
class PaddedBox
{
public:
    void add(const openvdb::Vec3d& p)
    {
        low_ = openvdb::math::minComponent(low_, p);
        high_ = openvdb::math::maxComponent(high_, p);
    }
    FloatBox padded(double pad) const
    {
        FloatBox box{};
        for (int k = 0; k < 3; ++k) {
            box.lo[k] = below(low_[k] - pad);
            box.hi[k] = -below(-high_[k] - pad);
        }
        return box;
    }

private:
    static float below(double x)
    {
        return std::nextafter(float(x), -std::numeric_limits<float>::infinity());
    }
    openvdb::Vec3d low_ = openvdb::Vec3d(std::numeric_limits<double>::infinity()), high_ = -low_;
};

/// Pairs of items of which many are near one another without meeting. An item is one piece or
/// several, which cover it. A piece that has few others near it gives its pairs and is done; the
/// others are halved and looked at again, so pieces become small only where there is a crowd. A
/// Piece has
///   std::uint32_t item;
///   BoxTree::Marks marks;        // two items with a mark in common are no pair
///   FloatBox box() const;        // around all of the piece
///   bool divisible() const;
///   Piece halve();               // becomes one half, and gives the other
template <class Piece> class CrowdedPairs
{
public:
    CrowdedPairs(std::vector<Piece> pieces, const PolledStop& stop)
        : pieces_(std::move(pieces)), stop_(stop), most_pieces_(4 * pieces_.size() + 1024)
    {
    }

    /// Appends pairs i < j of items for which keep(i, j) holds, some of them more than once. keep
    /// is called from several threads at a time, at least once for each pair with a common point.
    template <class Keep>
    void list(const Keep& keep, std::vector<std::array<std::uint32_t, 2>>& pairs)
    {
        for (int round = 0; !pieces_.empty() && !stop_.wanted(); ++round) {
            build_tree();
            const bool last = round == kMostRounds || pieces_.size() > most_pieces_;
            crowded_.assign(pieces_.size(), 0);
            near_.assign(last ? 0 : pieces_.size(), {});
            for_each_index(near_.size(), [&](std::size_t p) { look_around(p); });
            const std::vector<std::size_t> begins = items();
            std::vector<std::vector<std::uint32_t>> kept(begins.size() - 1);
            for_each_index(kept.size(), [&](std::size_t i) {
                kept[i] = kept_with(begins[i], begins[i + 1], keep);
            });
            for (std::size_t i = 0; i < kept.size(); ++i)
                for (const std::uint32_t other : kept[i]) {
                    const auto [low, high] = std::minmax(pieces_[begins[i]].item, other);
                    pairs.push_back({low, high});
                }
            halve_crowded();
        }
    }

private:
    // Pieces that have more others near them are halved. In the faces of a tet mesh each triangle
    // has a hundred others around its corners, and halves there have no fewer.
    static constexpr std::size_t kCrowd = 128;
    // Where items do cross one another no piece is small enough. Twenty rounds divide lengths by a
    // million; both bounds only limit what is spent before all pairs that are left are given.
    static constexpr int kMostRounds = 20;

    void build_tree()
    {
        boxes_.resize(pieces_.size());
        std::vector<BoxTree::Marks> marks(pieces_.size());
        for_each_index(pieces_.size(), [&](std::size_t p) {
            boxes_[p] = pieces_[p].box();
            marks[p] = pieces_[p].marks;
        });
        tree_.build(boxes_);
        tree_.mark(marks);
    }

    /// Calls visit(q), until it returns false, for the pieces of other items near piece p.
    template <class Visit> void for_each_near(std::size_t p, const Visit& visit) const
    {
        tree_.for_each_overlap_without(pieces_[p].marks, boxes_[p], [&](int i) {
            const auto q = static_cast<std::uint32_t>(i);
            return pieces_[q].item == pieces_[p].item || visit(q);
        });
    }

    /// Lists the pieces near p, or finds that they are too many.
    void look_around(std::size_t p)
    {
        const std::size_t most = pieces_[p].divisible() ? kCrowd : SIZE_MAX;
        std::vector<std::uint32_t>& near = near_[p];
        if (!stop_.wanted())
            for_each_near(p, [&](std::uint32_t q) {
                near.push_back(q);
                return near.size() <= most;
            });
        crowded_[p] = near.size() > most;
        if (crowded_[p])
            std::vector<std::uint32_t>().swap(near);
    }

    /// Where the pieces of each item begin, which stand together, and the end.
    std::vector<std::size_t> items() const
    {
        std::vector<std::size_t> begins;
        for (std::size_t p = 0; p < pieces_.size(); ++p)
            if (p == 0 || pieces_[p].item != pieces_[p - 1].item)
                begins.push_back(p);
        begins.push_back(pieces_.size());
        return begins;
    }

    /// The items that are kept with the one of these pieces, but for what crowded pieces have near
    /// them.
    template <class Keep>
    std::vector<std::uint32_t> kept_with(std::size_t begin, std::size_t end, const Keep& keep) const
    {
        const std::uint32_t item = pieces_[begin].item;
        std::vector<std::uint32_t> others;
        // Each pair once: by the smaller item, or by the piece that is done.
        const auto add = [&](std::uint32_t q) {
            if (crowded_[q] || item < pieces_[q].item)
                others.push_back(pieces_[q].item);
            return !stop_.wanted();
        };
        for (std::size_t p = begin; p < end; ++p)
            if (near_.empty())
                for_each_near(p, add);
            else
                std::for_each(near_[p].begin(), near_[p].end(), add);
        // Many pieces of one item lie near those of another.
        std::sort(others.begin(), others.end());
        others.erase(std::unique(others.begin(), others.end()), others.end());
        const auto rejected = [&](std::uint32_t other) {
            const auto [low, high] = std::minmax(item, other);
            return stop_.wanted() || !keep(low, high);
        };
        others.erase(std::remove_if(others.begin(), others.end(), rejected), others.end());
        return others;
    }

    /// Leaves quarters of the crowded pieces.
    void halve_crowded()
    {
        std::vector<Piece> next;
        for (std::size_t p = 0; p < pieces_.size(); ++p) {
            if (!crowded_[p])
                continue;
            Piece one = pieces_[p], other = one.halve();
            for (Piece* half : {&one, &other}) {
                if (half->divisible())
                    next.push_back(half->halve());
                next.push_back(*half);
            }
        }
        pieces_ = std::move(next);
    }

    std::vector<Piece> pieces_;
    const PolledStop& stop_;
    std::size_t most_pieces_;
    std::vector<FloatBox> boxes_; ///< of the pieces
    BoxTree tree_;
    /// By piece; empty where it is crowded, and in the last round, when they are too many.
    std::vector<std::vector<std::uint32_t>> near_;
    std::vector<char> crowded_;
};

} // namespace vdb_shell
