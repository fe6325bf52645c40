// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/box_ray.h"
#include "core/float_box.h"
#include "core/parallel.h"
#include "core/raw_vector.h"

#include <openvdb/Types.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace vdb_shell
{

/// A tree over boxes that may be rebuilt every round, and is queried in parallel: for a box, a ray,
/// or all boxes of a group at a time. Same order of what is found for any number of threads.
class BoxTree
{
    static constexpr std::size_t kWide = 4;

public:
    /// Over the boxes box_of(0) to box_of(count - 1), which is called twice for each, from any
    /// thread: a list of tens of millions of boxes beside the tree would take a gigabyte.
    template <class BoxOf> void build(std::size_t count, const BoxOf& box_of)
    {
        RawVector<Item> items = items_for(count);
        for_each_index(
            count,
            [&](std::size_t i) {
                // Twice the middle is in the same order as the middle, without halving.
                const FloatBox box = box_of(i);
                const FourFloats sum = box.lo + box.hi;
                items[i] = {{sum[0], sum[1], sum[2]}, static_cast<int>(i)};
            },
            kGrain);
        split(items, 0, static_cast<int>(count));
        for_each_index(
            leaves_.size(),
            [&](std::size_t leaf) {
                leaves_[leaf] = FourBoxes::none();
                for (std::size_t place = kWide * leaf; place < leaf_end(leaf); ++place) {
                    item_[place] = items[place].box;
                    set_box(place, box_of(static_cast<std::size_t>(items[place].box)));
                }
            },
            kGrain / kWide);
        // Of tens of millions of boxes these and the nodes take gigabytes.
        items = {};
        add_all_nodes();
    }
    void build(const std::vector<FloatBox>& boxes)
    {
        build(boxes.size(), [&](std::size_t i) { return boxes[i]; });
    }
    std::size_t size() const { return item_.size(); }
    /// Same boxes, moved: the tree keeps its shape. Only those marked in `changed` are looked at,
    /// and the nodes over them; empty: all.
    template <class BoxOf>
    void refit(const BoxOf& box_of, const std::vector<std::uint8_t>& changed = {})
    {
        for_each_index(
            subtrees_.size(),
            [&](std::size_t i) {
                bool moved = false;
                for (int place = subtrees_[i].begin; place < subtrees_[i].end; ++place) {
                    const auto item = static_cast<std::size_t>(item_[std::size_t(place)]);
                    if (!changed.empty() && !changed[item])
                        continue;
                    set_box(std::size_t(place), box_of(item));
                    moved = true;
                }
                if (moved)
                    fit_subtree(subtrees_[i]);
            },
            1);
        fit_upper_nodes();
    }
    void refit(const std::vector<FloatBox>& boxes, const std::vector<std::uint8_t>& changed = {})
    {
        refit([&](std::size_t i) { return boxes[i]; }, changed);
    }

    /// Makes ready for widen(); to be called after each build().
    void index_parents();
    /// Box i becomes as much larger as to hold `box` too, at a cost of the depth of the tree.
    /// Precondition: index_parents. For boxes that stay and are soon built anew; those that come
    /// and go one by one lie in resample/moving_boxes.h.
    void widen(std::size_t i, const FloatBox& box);
    /// Box i becomes `box`, at the same cost. Precondition: index_parents.
    void replace(std::size_t i, const FloatBox& box);

    /// Numbers that a box carries, kNoMark where it has fewer: so that all boxes of a kind can be
    /// passed over at once.
    using Marks = std::array<std::uint32_t, 3>;
    static constexpr std::uint32_t kNoMark = ~0U;
    /// Precondition: as many as boxes. To be called after each build().
    void mark(const std::vector<Marks>& marks);

    /// Calls visit(i) for every box i that overlaps `query`.
    template <class Visit> void for_each_overlap(const FloatBox& query, Visit&& visit) const
    {
        const FourBoxes wanted = FourBoxes::same(query);
        descend([&](int, const FourBoxes& boxes) { return boxes.overlaps(wanted); },
                [&](std::size_t at) {
                    visit(item_[at]);
                    return true;
                });
    }
    /// The same until visit(i) returns false.
    template <class Visit> void for_each_overlap_while(const FloatBox& query, Visit&& visit) const
    {
        const FourBoxes wanted = FourBoxes::same(query);
        descend([&](int, const FourBoxes& boxes) { return boxes.overlaps(wanted); },
                [&](std::size_t at) { return visit(item_[at]); });
    }
    /// The same but for boxes that carry one of these marks, until visit(i) returns false.
    /// Precondition: mark().
    template <class Visit>
    void for_each_overlap_without(const Marks& marks, const FloatBox& query, Visit&& visit) const
    {
        const FourBoxes wanted = FourBoxes::same(query);
        const bool any = marks != Marks{kNoMark, kNoMark, kNoMark};
        descend(
            [&](int four, const FourBoxes& boxes) {
                const unsigned met = boxes.overlaps(wanted);
                return any ? without(marks, four, met) : met;
            },
            [&](std::size_t at) { return visit(item_[at]); });
    }
    static bool have_common(const Marks& a, const Marks& b)
    {
        bool found = false;
        for (const std::uint32_t mark : a)
            found |= mark != kNoMark && (mark == b[0] || mark == b[1] || mark == b[2]);
        return found;
    }

    /// Calls visit(i) for the boxes the ray p + t d, 0 <= t <= limit, may meet, those that it comes
    /// to first about first; visit may lower limit.
    template <class Visit>
    void for_each_on_ray(const openvdb::Vec3d& p, const openvdb::Vec3d& d, const double& limit,
                         Visit&& visit) const
    {
        descend_along(
            BoxRay(p, d), limit, [](int, unsigned met) { return met; },
            [&](std::size_t at) {
                visit(item_[at]);
                return true;
            });
    }
    /// The same but for boxes that carry one of these marks, until visit(i) returns false.
    /// Precondition: mark().
    template <class Visit>
    void for_each_on_ray_without(const Marks& marks, const openvdb::Vec3d& p,
                                 const openvdb::Vec3d& d, double limit, Visit&& visit) const
    {
        descend_along(
            BoxRay(p, d), limit, [&](int four, unsigned met) { return without(marks, four, met); },
            [&](std::size_t at) { return visit(item_[at]); });
    }

    /// Boxes that lie together, for those who ask about all of them: one walk serves a group.
    std::size_t groups() const { return (item_.size() + kGroup - 1) / kGroup; }
    /// Boxes near each other, four to a block: what a thread needs to look through a group.
    class Near
    {
    public:
        void clear() { block_.clear(), item_.clear(); }
        std::size_t size() const { return item_.size(); }
        void add(const FloatBox& box, int item);
        /// Calls visit(item) for each box that overlaps this one, but for the first `skipped`,
        /// until one returns true; whether one did.
        template <class Visit>
        bool any_overlap(const FloatBox& box, Visit&& visit, std::size_t skipped = 0) const
        {
            const FourBoxes wanted = FourBoxes::same(box);
            unsigned left = ~0U << skipped % kWide;
            for (std::size_t b = skipped / kWide; b < block_.size(); ++b, left = ~0U)
                for (unsigned hits = block_[b].overlaps(wanted) & left; hits != 0; hits &= hits - 1)
                    if (visit(item_[kWide * b + std::size_t(__builtin_ctz(hits))]))
                        return true;
            return false;
        }

    private:
        std::vector<FourBoxes> block_;
        std::vector<int> item_;
    };
    /// The boxes that overlap this one, for those who go on to look at parts of it, in the order of
    /// the leaves. False if there are more than `most`, and then not all are listed.
    bool list_overlaps(const FloatBox& box, Near& near, std::size_t most = SIZE_MAX) const
    {
        return list_overlaps_from(0, box, near, most);
    }
    /// Calls visit(i, j) for every box i of the group with wanted(i) and every box j of `other`
    /// that overlaps it; `other` may be this tree. False, and nothing is called, where more than
    /// `most` boxes overlap the one around the group.
    template <class Wanted, class Visit>
    bool for_each_overlap_of(std::size_t group, const BoxTree& other, Near& near,
                             const Wanted& wanted, Visit&& visit, std::size_t most = SIZE_MAX) const
    {
        const std::size_t begin = group * kGroup, end = std::min(item_.size(), begin + kGroup);
        bool any = false;
        FloatBox all{};
        for (std::size_t i = begin; i < end; ++i)
            if (wanted(item_[i])) {
                if (!any)
                    all = box_at(i);
                all.add(box_at(i));
                any = true;
            }
        if (!any)
            return true;
        if (!other.list_overlaps(all, near, most))
            return false;
        for (std::size_t i = begin; i < end; ++i)
            if (wanted(item_[i]))
                near.any_overlap(box_at(i), [&](int j) {
                    visit(item_[i], j);
                    return false;
                });
        return true;
    }
    /// Calls visit(i, j) for every box i of the group and every box j that overlaps it and stands
    /// behind it in the tree: over all groups each pair comes once, for half the work. False, and
    /// nothing is called, where more than `most` boxes overlap the one around the group, unless
    /// nearly all of them stand before it.
    template <class Visit>
    bool for_each_pair_of(std::size_t group, Near& near, Visit&& visit,
                          std::size_t most = SIZE_MAX) const
    {
        const std::size_t begin = group * kGroup, end = std::min(item_.size(), begin + kGroup);
        FloatBox all = box_at(begin);
        for (std::size_t i = begin + 1; i < end; ++i)
            all.add(box_at(i));
        // Most groups of a good surface have fewer from here on; of the others all are counted, for
        // the last ones of a crowd have few behind them.
        const std::size_t few = most / 16;
        if (!list_overlaps_from(begin, all, near, most) ||
            (near.size() > few && !overlap_at_most(all, most)))
            return false;
        for (std::size_t i = begin; i < end; ++i)
            near.any_overlap(
                box_at(i),
                [&](int j) {
                    visit(item_[i], j);
                    return false;
                },
                // The group itself is listed first.
                i - begin + 1);
        return true;
    }
    /// Calls visit(i) for the boxes of a group.
    template <class Visit> void for_each_of(std::size_t group, Visit&& visit) const
    {
        for (std::size_t i = group * kGroup; i < std::min(item_.size(), (group + 1) * kGroup); ++i)
            visit(item_[i]);
    }

private:
    /// Up to four nodes or leaves: a leaf by what ~ makes of its number.
    struct Node {
        FourBoxes box;
        std::array<int, kWide> child;
        unsigned children;
        int end; ///< the place behind its last box
    };
    /// The node over a range of boxes, and all below it, which stand behind it.
    struct Subtree {
        std::size_t node, nodes;
        int begin, end;
    };
    /// What the splits move: the number of a box with its middle, so that boxes themselves stay in
    /// place.
    struct Item {
        std::array<float, 3> twice_middle;
        int box;
    };
    // The tree is split at medians, twice a node, so its depth stays below 17.
    static constexpr int kStack = 64;
    static constexpr std::size_t kGroup = 16;
    static constexpr int kLeaf = kWide; ///< boxes of a leaf at most
    // Boxes that one thread takes at a time: some microseconds' work.
    static constexpr std::size_t kGrain = 1024;

    RawVector<Item> items_for(std::size_t count);
    static int middle_of(int begin, int end);
    class NodeCounts;
    static void split(RawVector<Item>& items, int begin, int end);
    template <class Visit> static void for_each_child(int begin, int end, const Visit& visit);
    void add_upper_node(std::size_t id, int begin, int end, NodeCounts& counts);
    int add_nodes(int begin, int end, std::size_t& next);
    void add_all_nodes();
    void fit_subtree(const Subtree& subtree);
    void fit_upper_nodes();

    /// Four boxes or fewer, those at the places from kWide * leaf on: splits leave all leaves full
    /// but for the last.
    std::size_t leaf_end(std::size_t leaf) const
    {
        return std::min(item_.size(), kWide * (leaf + 1));
    }
    static std::size_t leaf_of(int child) { return static_cast<std::size_t>(~child); }
    FloatBox box_at(std::size_t place) const { return leaves_[place / kWide].get(place % kWide); }
    void set_box(std::size_t place, const FloatBox& box)
    {
        leaves_[place / kWide].set(place % kWide, box);
    }
    /// The place behind the last box of a node or leaf; of the last leaf a place that is not used.
    std::size_t end_of(int four) const
    {
        return four >= 0 ? std::size_t(nodes_[std::size_t(four)].end) : kWide * (leaf_of(four) + 1);
    }
    bool overlap_at_most(const FloatBox& box, std::size_t most) const
    {
        std::size_t met = 0;
        for_each_overlap_while(box, [&](int) { return ++met <= most; });
        return met <= most;
    }
    /// list_overlaps of the boxes from a place on with which a leaf begins.
    bool list_overlaps_from(std::size_t place, const FloatBox& box, Near& near,
                            std::size_t most) const;
    FloatBox around_leaf(std::size_t leaf) const;
    static FloatBox around(const Node& node);
    /// Where a walk begins: nothing where there are no boxes.
    int root() const { return nodes_.empty() ? ~0 : 0; }
    unsigned lanes_of(int four) const
    {
        const std::size_t count = four >= 0 ? nodes_[std::size_t(four)].children
                                            : leaf_end(leaf_of(four)) - kWide * leaf_of(four);
        return (1U << count) - 1U;
    }
    const FourBoxes& boxes_of(int four) const
    {
        return four >= 0 ? nodes_[std::size_t(four)].box : leaves_[leaf_of(four)];
    }

    /// Calls visit(place), until it returns false, for every box that is met, leaving out what lies
    /// under boxes that are not: meets(node or leaf, its four boxes) has a bit for each that is.
    template <class Meets, class Visit> void descend(const Meets& meets, Visit&& visit) const
    {
        if (item_.empty())
            return;
        std::array<int, kStack> stack;
        int top = 0;
        stack[top++] = root();
        while (top > 0) {
            const int at = stack[--top];
            // Lanes that are not used overlap nothing.
            unsigned met = meets(at, boxes_of(at));
            if (at < 0) {
                for (; met != 0; met &= met - 1)
                    if (!visit(kWide * leaf_of(at) + std::size_t(__builtin_ctz(met))))
                        return;
                continue;
            }
            const Node& n = nodes_[std::size_t(at)];
            for (std::size_t lane = kWide; lane-- > 0;)
                if ((met >> lane & 1U) != 0)
                    stack[top++] = n.child[lane];
        }
    }

    /// The same along a ray, nearer nodes first: what visit finds in them lowers the limit before
    /// those behind are looked at. left(node or leaf, met) may take bits away from those that are
    /// met.
    template <class Left, class Visit>
    void descend_along(const BoxRay& ray, const double& limit, const Left& left,
                       Visit&& visit) const
    {
        if (item_.empty())
            return;
        struct Waiting {
            int four;
            double entry;
        };
        std::array<Waiting, kStack> stack;
        std::size_t top = 0;
        stack[top++] = {root(), 0.0};
        std::array<double, kWide> entry;
        while (top > 0) {
            const Waiting at = stack[--top];
            if (at.entry > BoxRay::no_less(limit))
                continue;
            unsigned met =
                left(at.four, ray.meets(boxes_of(at.four), limit, entry) & lanes_of(at.four));
            const std::size_t first = top;
            for (; met != 0; met &= met - 1) {
                const auto lane = std::size_t(__builtin_ctz(met));
                if (at.four < 0) {
                    if (entry[lane] <= BoxRay::no_less(limit) &&
                        !visit(kWide * leaf_of(at.four) + lane))
                        return;
                    continue;
                }
                const int child = nodes_[std::size_t(at.four)].child[lane];
                // The nearest is on top of the stack.
                std::size_t place = top++;
                for (; place > first && stack[place - 1].entry < entry[lane]; --place)
                    stack[place] = stack[place - 1];
                stack[place] = {child, entry[lane]};
            }
        }
    }

    /// Of the lanes of a node or leaf that are met those without these marks.
    unsigned without(const Marks& marks, int four, unsigned met) const
    {
        const Marks* const common =
            four >= 0 ? &common_[kWide * std::size_t(four)] : &own_[kWide * leaf_of(four)];
        for (unsigned left = met; left != 0; left &= left - 1) {
            const auto lane = unsigned(__builtin_ctz(left));
            if (have_common(marks, common[lane]))
                met &= ~(1U << lane);
        }
        return met;
    }
    RawVector<int> item_;         ///< in the order of the leaves
    RawVector<FourBoxes> leaves_; ///< the boxes of the items, in that order
    RawVector<Node> nodes_;       ///< each before its children
    /// What a thread takes at a time, and the nodes above these, each before its children.
    std::vector<Subtree> subtrees_;
    std::vector<std::size_t> upper_;
    /// Of index_parents: the place of each item; the node and the lane that hold a leaf, and those
    /// that hold a node, of the root -1.
    struct Lane {
        int node;
        unsigned lane;
    };
    std::vector<std::size_t> place_;
    std::vector<Lane> lane_of_leaf_, lane_of_node_;
    /// Of mark(): by place what its box carries, and kWide to a node what all boxes under a lane
    /// do.
    std::vector<Marks> own_, common_;
};

} // namespace vdb_shell
