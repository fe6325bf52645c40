// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/four_floats.h"

#include <openvdb/Types.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

namespace vdb_shell::growth
{

using openvdb::Vec3d;

struct Box {
    Vec3d lo{1e300}, hi{-1e300};
    void add(const Vec3d& p)
    {
        for (int k = 0; k < 3; ++k)
            lo[k] = std::min(lo[k], p[k]), hi[k] = std::max(hi[k], p[k]);
    }
    void add(const Box& o) { add(o.lo), add(o.hi); }
    void inflate(double r) { lo -= Vec3d(r), hi += Vec3d(r); }
    bool meets_ray(const Vec3d& p, const Vec3d& d, double limit) const
    {
        double t0 = 0, t1 = limit;
        for (int k = 0; k < 3; ++k) {
            if (d[k] == 0) {
                if (p[k] < lo[k] || p[k] > hi[k])
                    return false;
                continue;
            }
            const double a = (lo[k] - p[k]) / d[k], b = (hi[k] - p[k]) / d[k];
            t0 = std::max(t0, std::min(a, b)), t1 = std::min(t1, std::max(a, b));
        }
        return t0 <= t1 * (1 + 1e-9) + 1e-300;
    }
    bool contains(const Vec3d& p) const
    {
        return lo[0] <= p[0] && p[0] <= hi[0] && lo[1] <= p[1] && p[1] <= hi[1] && lo[2] <= p[2] &&
               p[2] <= hi[2];
    }
    bool overlaps(const Box& o) const
    {
        return lo[0] <= o.hi[0] && o.lo[0] <= hi[0] && lo[1] <= o.hi[1] && o.lo[1] <= hi[1] &&
               lo[2] <= o.hi[2] && o.lo[2] <= hi[2];
    }
};

/// A box in floats, rounded outwards; the fourth lane is always within.
struct FloatBox {
    FourFloats lo, hi;
    bool overlaps(const FloatBox& o) const
    {
        using TwoWords __attribute__((vector_size(16))) = long long;
        const auto within = (TwoWords)((lo <= o.hi) & (o.lo <= hi));
        return (within[0] & within[1]) == -1;
    }
    void add(const FloatBox& o) { lo = least_of(lo, o.lo), hi = most_of(hi, o.hi); }
    Box widened() const
    {
        return {{double(lo[0]), double(lo[1]), double(lo[2])},
                {double(hi[0]), double(hi[1]), double(hi[2])}};
    }
};

FloatBox float_box(const Box& box);

/// A tree over boxes that is rebuilt every round and queried in parallel; core/box_pairs.h finds
/// all pairs of a fixed list, this one answers a box, a group of its boxes or a ray at a time.
/// What it finds overlaps but for the rounding to floats; it misses nothing.
class BoxTree
{
public:
    void build(const std::vector<Box>& boxes);
    /// Same boxes, moved: the tree keeps its shape. Precondition: as many boxes as in build().
    /// Only those marked in `changed` are looked at; empty: all.
    void refit(const std::vector<Box>& boxes, const std::vector<std::uint8_t>& changed = {});

    /// Calls visit(i) for every box i that overlaps `query`.
    template <class Visit> void for_each_overlap(const Box& query, Visit&& visit) const
    {
        const FloatBox box = float_box(query);
        descend([&](const FloatBox& other) { return box.overlaps(other); },
                [&](std::size_t at) { visit(item_[at]); });
    }

    /// Calls visit(i) for the boxes the ray p + t d, 0 <= t <= limit, may meet; visit may lower
    /// limit.
    template <class Visit>
    void for_each_on_ray(const Vec3d& p, const Vec3d& d, const double& limit, Visit&& visit) const
    {
        descend([&](const FloatBox& box) { return box.widened().meets_ray(p, d, limit); },
                [&](std::size_t at) { visit(item_[at]); });
    }

    /// Boxes that lie together, for those who ask about all of them: one walk serves a group.
    std::size_t groups() const { return (item_.size() + kGroup - 1) / kGroup; }
    /// What a thread needs to look through a group.
    struct Near {
        std::vector<FloatBox> box;
        std::vector<int> item;
    };
    /// The boxes that overlap this one, for those who go on to look at parts of it.
    void list_overlaps(const FloatBox& box, Near& near) const
    {
        near.box.clear(), near.item.clear();
        descend([&](const FloatBox& other) { return box.overlaps(other); },
                [&](std::size_t at) {
                    near.box.push_back(boxes_[at]);
                    near.item.push_back(item_[at]);
                });
    }
    /// Calls visit(i, j) for every box i of the group with wanted(i) and every box j of `other`
    /// that overlaps it; `other` may be this tree.
    template <class Wanted, class Visit>
    void for_each_overlap_of(std::size_t group, const BoxTree& other, Near& near,
                             const Wanted& wanted, Visit&& visit) const
    {
        const std::size_t begin = group * kGroup, end = std::min(item_.size(), begin + kGroup);
        bool any = false;
        FloatBox all{};
        for (std::size_t i = begin; i < end; ++i)
            if (wanted(item_[i])) {
                if (!any)
                    all = boxes_[i];
                all.add(boxes_[i]);
                any = true;
            }
        if (!any)
            return;
        other.list_overlaps(all, near);
        for (std::size_t i = begin; i < end; ++i)
            if (wanted(item_[i]))
                for (std::size_t k = 0; k < near.box.size(); ++k)
                    if (boxes_[i].overlaps(near.box[k]))
                        visit(item_[i], near.item[k]);
    }

private:
    struct Node {
        FloatBox box;
        int begin, end;
        int right; ///< negative: a leaf; the left child follows its parent
    };
    // The tree is split at medians, so its depth stays below 32.
    static constexpr int kStack = 64;
    static constexpr std::size_t kGroup = 16;

    void split(int id, int begin, int end);

    /// Calls visit(place) for every box that is met, leaving out what lies under boxes that are
    /// not.
    template <class Meets, class Visit> void descend(const Meets& meets, Visit&& visit) const
    {
        if (nodes_.empty())
            return;
        std::array<int, kStack> stack;
        int top = 0;
        stack[top++] = 0;
        while (top > 0) {
            const Node& n = nodes_[static_cast<std::size_t>(stack[--top])];
            if (!meets(n.box))
                continue;
            if (n.right < 0) {
                for (int i = n.begin; i < n.end; ++i)
                    if (meets(boxes_[static_cast<std::size_t>(i)]))
                        visit(static_cast<std::size_t>(i));
            } else {
                stack[top++] = n.right;
                stack[top++] = static_cast<int>(&n - nodes_.data()) + 1;
            }
        }
    }

    std::vector<int> item_;       ///< in the order of the leaves
    std::vector<FloatBox> boxes_; ///< of the items, in that order
    std::vector<Node> nodes_;
};

} // namespace vdb_shell::growth
