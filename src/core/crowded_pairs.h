// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/box_tree.h"
#include "core/layered_pairs.h"
#include "core/pair_bounds.h"
#include "core/parallel.h"
#include "core/polled_stop.h"
#include "core/sort_unique.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <numeric>
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
            box.lo[k] = float_below(low_[k] - pad);
            box.hi[k] = -float_below(-high_[k] - pad);
        }
        return box;
    }

private:
    openvdb::Vec3d low_ = openvdb::Vec3d(std::numeric_limits<double>::infinity()), high_ = -low_;
};

/// Pairs of items of which many are near one another without meeting. An item is one piece or
/// several, which cover it. A piece that has few others near it gives its pairs and is done; the
/// others are halved and looked at again, so pieces become small only where there is a crowd, and
/// only while that makes fewer pairs: long thin pieces become free of each other, layers do not,
/// and are compared by bounds along their normals (core/layered_pairs.h). A Piece has
///   std::uint32_t item;
///   BoxTree::Marks marks;        // two items with a mark in common are no pair
///   double pad;                  // how far off its corners may be
///   FloatBox box() const;        // around all of the piece
///   FlatCorners corners() const; // the piece is within their hull
///   bool surely_apart(const Piece& other) const; // a quick test, which may say no
///   bool divisible() const;
///   Piece halve();               // becomes one half, and gives the other
template <class Piece> class CrowdedPairs
{
public:
    CrowdedPairs(std::vector<Piece> pieces, const PairBounds& wanted, const PolledStop& stop)
        : pieces_(std::move(pieces)), whole_(pieces_), whole_of_(pieces_.size()), wanted_(wanted),
          stop_(stop), most_pieces_(std::max(4 * pieces_.size() + 1024, kMostPieces))
    {
        std::iota(whole_of_.begin(), whole_of_.end(), 0U);
    }

    /// Appends pairs i < j of items for which keep(i, j) holds, some of them more than once. keep
    /// is called from several threads at a time, at least once for each pair with a common point.
    /// False if there are more pairs than are wanted; then not all are there.
    template <class Keep>
    bool list(const Keep& keep, std::vector<std::array<std::uint32_t, 2>>& pairs)
    {
        const std::size_t most = wanted_.most_of(whole_.size());
        double before = 0;
        for (int round = 0; !pieces_.empty() && !stop_.wanted(); ++round) {
            build_tree();
            const Crowd found = sampled_crowd();
            const bool in_vain = round > 0 && 2 * found.near > before;
            // Layers are looked for among whole items, from the beginning: that has to pay.
            if (in_vain && found.near > kWorthHalving * double(pieces_.size()))
                return LayeredPairs<Piece>(whole_items(), wanted_, stop_).list(keep, pairs);
            before = found.near_crowded;
            const bool last = round == kMostRounds || in_vain ||
                              (round > 0 && found.near_crowded < kWorthHalving * found.crowded);
            crowded_.assign(pieces_.size(), 0);
            near_.assign(last ? 0 : pieces_.size(), {});
            for_each_index(near_.size(), [&](std::size_t p) { look_around(p); });
            give_up_if_too_many();
            if (!list_round(keep, most, pairs))
                return false;
            halve_crowded();
        }
        return true;
    }

private:
    // Pieces that have more others near them are halved. In the faces of a tet mesh each triangle
    // has a hundred others around its corners, and halves there have no fewer.
    static constexpr std::size_t kCrowd = 128;
    // Others near a piece from which on it pays to quarter it: four new pieces cost some 7 us, and
    // save three quarters of the others, at 20 ns each (8,000 needles, GCC 12).
    static constexpr double kWorthHalving = 512;
    // Twenty rounds divide lengths by a million. A piece takes some 250 bytes, so these half a GiB,
    // and four of each item, where that is more, a KiB an item; both bounds only limit what is
    // spent before all pairs that are left are given.
    static constexpr int kMostRounds = 20;
    static constexpr std::size_t kMostPieces = std::size_t(1) << 21;
    static constexpr std::size_t kSamples = 256;

    /// How many pairs of pieces are near each other, by samples.
    struct Crowd {
        double near, near_crowded; ///< of all pieces, and of those that have a crowd around them
        double crowded;            ///< how many these are
    };
    Crowd sampled_crowd() const
    {
        // Odd, as the four quarters of a piece stand in a row.
        const std::size_t step = ((pieces_.size() + kSamples - 1) / kSamples) | 1U;
        std::vector<std::size_t> near((pieces_.size() + step - 1) / step);
        for_each_index(
            near.size(),
            [&](std::size_t s) {
                for_each_near(s * step, [&](std::uint32_t) { return ++near[s], !stop_.wanted(); });
            },
            1);
        Crowd crowd{0, 0, 0};
        for (const std::size_t n : near) {
            crowd.near += double(step * n);
            crowd.near_crowded += n > kCrowd ? double(step * n) : 0;
            crowd.crowded += n > kCrowd ? double(step) : 0;
        }
        return crowd;
    }
    /// All of those of which a piece is left.
    std::vector<Piece> whole_items() const
    {
        std::vector<Piece> left;
        for (std::size_t p = 0; p < whole_of_.size(); ++p)
            if (p == 0 || whole_of_[p] != whole_of_[p - 1])
                left.push_back(whole_[whole_of_[p]]);
        return left;
    }

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
            return whole_of_[q] == whole_of_[p] || visit(q);
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

    std::size_t quarters_of_crowded() const
    {
        return 4 * std::size_t(std::count(crowded_.begin(), crowded_.end(), 1));
    }
    /// Where the quarters of crowded pieces would be too many, none is taken for crowded.
    void give_up_if_too_many()
    {
        if (quarters_of_crowded() <= most_pieces_)
            return;
        std::fill(crowded_.begin(), crowded_.end(), 0);
        near_.clear();
    }

    /// The pairs of the pieces that are not crowded; false if there are more than are wanted.
    template <class Keep>
    bool list_round(const Keep& keep, std::size_t most,
                    std::vector<std::array<std::uint32_t, 2>>& pairs) const
    {
        const std::vector<std::size_t> begins = items();
        // An item may meet all others. Not more than some are looked at before what they have is
        // counted, and these always the same, so what is found does not depend on threads.
        constexpr std::size_t kAtOnce = 1024;
        const std::size_t items = begins.size() - 1, at_once = most == SIZE_MAX ? items : kAtOnce;
        for (std::size_t first = 0; first < items; first += at_once) {
            std::vector<std::vector<std::uint32_t>> kept(std::min(at_once, items - first));
            for_each_index(kept.size(), [&](std::size_t i) {
                kept[i] = kept_with(begins[first + i], begins[first + i + 1], keep);
            });
            for (std::size_t i = 0; i < kept.size(); ++i)
                for (const std::uint32_t other : kept[i]) {
                    const auto [low, high] =
                        std::minmax(whole_[whole_of_[begins[first + i]]].item, whole_[other].item);
                    pairs.push_back({low, high});
                }
            if (pairs.size() >= most)
                return false;
        }
        return true;
    }

    /// Where the pieces of each item begin, which stand together, and the end.
    std::vector<std::size_t> items() const
    {
        std::vector<std::size_t> begins;
        for (std::size_t p = 0; p < pieces_.size(); ++p)
            if (p == 0 || whole_of_[p] != whole_of_[p - 1])
                begins.push_back(p);
        begins.push_back(pieces_.size());
        return begins;
    }

    /// The items that are kept with the one of these pieces, but for what crowded pieces have near
    /// them.
    template <class Keep>
    std::vector<std::uint32_t> kept_with(std::size_t begin, std::size_t end, const Keep& keep) const
    {
        const std::uint32_t own = whole_of_[begin];
        std::vector<std::uint32_t> others;
        // Each pair once: by the smaller item, or by the piece that is done.
        const auto add = [&](std::uint32_t q) {
            if ((crowded_[q] || own < whole_of_[q]) &&
                !wanted_.both_settled(whole_[own].item, whole_[whole_of_[q]].item))
                others.push_back(whole_of_[q]);
            return !stop_.wanted();
        };
        for (std::size_t p = begin; p < end; ++p)
            if (near_.empty())
                for_each_near(p, add);
            else
                std::for_each(near_[p].begin(), near_[p].end(), add);
        // Many pieces of one item lie near those of another.
        sort_unique(others);
        const auto rejected = [&](std::uint32_t other) {
            const auto [low, high] = std::minmax(whole_[own].item, whole_[other].item);
            return stop_.wanted() || whole_[own].surely_apart(whole_[other]) || !keep(low, high);
        };
        others.erase(std::remove_if(others.begin(), others.end(), rejected), others.end());
        return others;
    }

    /// Leaves quarters of the crowded pieces.
    void halve_crowded()
    {
        std::vector<Piece> next;
        std::vector<std::uint32_t> whole_of_next;
        next.reserve(quarters_of_crowded());
        whole_of_next.reserve(next.capacity());
        for (std::size_t p = 0; p < pieces_.size(); ++p) {
            if (!crowded_[p])
                continue;
            Piece one = pieces_[p], other = one.halve();
            for (Piece* half : {&one, &other}) {
                if (half->divisible())
                    next.push_back(half->halve());
                next.push_back(*half);
            }
            whole_of_next.resize(next.size(), whole_of_[p]);
        }
        pieces_ = std::move(next);
        whole_of_ = std::move(whole_of_next);
    }

    std::vector<Piece> pieces_, whole_;   ///< the second as they were given, one an item
    std::vector<std::uint32_t> whole_of_; ///< of each piece; pieces are many, and this is small
    const PairBounds& wanted_;
    const PolledStop& stop_;
    std::size_t most_pieces_;
    std::vector<FloatBox> boxes_; ///< of the pieces
    BoxTree tree_;
    /// By piece; empty where it is crowded, and in the last round, when they are too many.
    std::vector<std::vector<std::uint32_t>> near_;
    std::vector<char> crowded_;
};

} // namespace vdb_shell
