// SPDX-License-Identifier: Apache-2.0

// A bounding volume hierarchy over axis-parallel boxes, split at the median of the boxes' middles
// along the longest extent. Two levels of halves make one node, so a node has up to four children,
// whose boxes are compared by one group of vector instructions. Invariant: the box of a node holds
// all boxes below it exactly, for least and greatest of floats are not rounded; so a query never
// misses a box, whatever the shape of the tree. Building takes O(n log n). Trap: refit() keeps the
// shape, so answers stay right but become slower when boxes move far from each other.

#include "core/box_tree.h"

#include "core/stage_stop.h"

#include <cassert>
#include <limits>
#include <map>

namespace vdb_shell
{

namespace
{

// Below this many boxes a second thread costs more than it saves.
constexpr int kParallel = 512;
// Boxes of a subtree whose nodes one thread makes: a tenth of a millisecond's work.
constexpr int kSubtree = 2048;

} // namespace

RawVector<BoxTree::Item> BoxTree::items_for(std::size_t count)
{
    nodes_.clear();
    subtrees_.clear();
    upper_.clear();
    item_.resize(count);
    leaves_.resize((count + kWide - 1) / kWide);
    return RawVector<Item>(count);
}

/// Where a range of more than kLeaf boxes is split: by number alone, so the shape of the tree
/// follows from how many boxes there are. About in the middle, so that groups and leaves are full
/// but for the last ones: halves of halves end anywhere between two and four boxes, and leaves of
/// two are twice as many nodes.
int BoxTree::middle_of(int begin, int end)
{
    const int count = end - begin, whole = count > int(kGroup) ? int(kGroup) : kLeaf;
    return begin + (count / 2 + whole - 1) / whole * whole;
}

/// Calls visit(begin, end) for what becomes a child of the node over a range of more than kLeaf
/// boxes. The ranges are those that split() makes, or else boxes that lie far apart would come into
/// one node. A half that is small enough for a leaf becomes a child as it is.
template <class Visit> void BoxTree::for_each_child(int begin, int end, const Visit& visit)
{
    const int middle = middle_of(begin, end);
    for (const auto& [from, to] : {std::pair(begin, middle), std::pair(middle, end)}) {
        if (to - from <= kLeaf) {
            visit(from, to);
            continue;
        }
        visit(from, middle_of(from, to));
        visit(middle_of(from, to), to);
    }
}

/// Of a range by its number of boxes: on each level of a tree there are two numbers at most.
class BoxTree::NodeCounts
{
public:
    std::size_t of(int boxes)
    {
        if (boxes <= kLeaf)
            return 0;
        const auto found = counted_.find(boxes);
        if (found != counted_.end())
            return found->second;
        std::size_t nodes = 1;
        for_each_child(0, boxes, [&](int from, int to) { nodes += of(to - from); });
        return counted_[boxes] = nodes;
    }

private:
    std::map<int, std::size_t> counted_;
};

void BoxTree::split(RawVector<Item>& items, int begin, int end)
{
    if (end - begin <= kLeaf)
        return;
    if (end - begin >= kParallel)
        stop_if_stage_wants();
    const auto first = items.begin() + begin, last = items.begin() + end;
    std::array<float, 3> low = first->twice_middle, high = low;
    std::for_each(first, last, [&](const Item& item) {
        for (std::size_t k = 0; k < 3; ++k) {
            low[k] = std::min(low[k], item.twice_middle[k]);
            high[k] = std::max(high[k], item.twice_middle[k]);
        }
    });
    const float x = high[0] - low[0], y = high[1] - low[1], z = high[2] - low[2];
    const std::size_t axis = x >= y && x >= z ? 0 : y >= z ? 1 : 2;
    const int middle = middle_of(begin, end);
    // Ties are broken by index, so which box goes to which half depends neither on threads nor on
    // how the library finds a median. Only within a leaf the order is the one that the library's
    // algorithm leaves.
    std::nth_element(first, items.begin() + middle, last, [axis](const Item& a, const Item& b) {
        const float ca = a.twice_middle[axis], cb = b.twice_middle[axis];
        return ca != cb ? ca < cb : a.box < b.box;
    });
    if (end - begin < kParallel) {
        split(items, begin, middle);
        split(items, middle, end);
        return;
    }
    // The halves are disjoint ranges of the items, so both can be split at once.
    run_together([&] { split(items, begin, middle); }, [&] { split(items, middle, end); });
}

void BoxTree::add_all_nodes()
{
    if (item_.empty())
        return;
    NodeCounts counts;
    const auto boxes = static_cast<int>(item_.size());
    nodes_.resize(counts.of(boxes));
    add_upper_node(0, 0, boxes, counts);
    for_each_index(
        subtrees_.size(),
        [&](std::size_t i) {
            std::size_t next = subtrees_[i].node;
            add_nodes(subtrees_[i].begin, subtrees_[i].end, next);
            fit_subtree(subtrees_[i]);
        },
        1);
    fit_upper_nodes();
}

/// Makes the nodes above the subtrees and lists these.
void BoxTree::add_upper_node(std::size_t id, int begin, int end, NodeCounts& counts)
{
    if (end - begin <= kSubtree) {
        subtrees_.push_back({id, counts.of(end - begin), begin, end});
        return;
    }
    upper_.push_back(id);
    Node& n = nodes_[id];
    n = {FourBoxes::none(), {}, 0, end};
    std::size_t next = id + 1;
    for_each_child(begin, end, [&](int from, int to) {
        n.child[n.children++] = static_cast<int>(next);
        add_upper_node(next, from, to, counts);
        next += counts.of(to - from);
    });
}

/// The node or leaf over a range. `next`: the number of the first new node, then the one after the
/// last.
int BoxTree::add_nodes(int begin, int end, std::size_t& next)
{
    if (end - begin <= kLeaf)
        return ~(begin / kLeaf);
    const auto id = static_cast<int>(next);
    Node& n = nodes_[next++];
    n = {FourBoxes::none(), {}, 0, end};
    for_each_child(begin, end,
                   [&](int from, int to) { n.child[n.children++] = add_nodes(from, to, next); });
    return id;
}

void BoxTree::index_parents()
{
    place_.resize(item_.size());
    for (std::size_t i = 0; i < item_.size(); ++i)
        place_[static_cast<std::size_t>(item_[i])] = i;
    lane_of_leaf_.assign(leaves_.size(), {-1, 0});
    lane_of_node_.assign(nodes_.size(), {-1, 0});
    for (std::size_t i = 0; i < nodes_.size(); ++i)
        for (unsigned lane = 0; lane < nodes_[i].children; ++lane) {
            const int child = nodes_[i].child[lane];
            (child < 0 ? lane_of_leaf_[leaf_of(child)]
                       : lane_of_node_[std::size_t(child)]) = {static_cast<int>(i), lane};
        }
}

void BoxTree::widen(std::size_t i, const FloatBox& box)
{
    const std::size_t place = place_[i];
    FloatBox own = box_at(place);
    own.add(box);
    set_box(place, own);
    for (Lane at = lane_of_leaf_[place / kWide]; at.node >= 0;
         at = lane_of_node_[static_cast<std::size_t>(at.node)]) {
        FourBoxes& boxes = nodes_[static_cast<std::size_t>(at.node)].box;
        FloatBox wider = boxes.get(at.lane);
        wider.add(box);
        boxes.set(at.lane, wider);
    }
}

void BoxTree::replace(std::size_t i, const FloatBox& box)
{
    const std::size_t place = place_[i];
    set_box(place, box);
    FloatBox below = around_leaf(place / kWide);
    for (Lane at = lane_of_leaf_[place / kWide]; at.node >= 0;
         at = lane_of_node_[static_cast<std::size_t>(at.node)]) {
        Node& n = nodes_[static_cast<std::size_t>(at.node)];
        n.box.set(at.lane, below);
        below = around(n);
    }
}

FloatBox BoxTree::around_leaf(std::size_t leaf) const
{
    FloatBox all = box_at(kWide * leaf);
    for (std::size_t place = kWide * leaf + 1; place < leaf_end(leaf); ++place)
        all.add(box_at(place));
    return all;
}

FloatBox BoxTree::around(const Node& node)
{
    FloatBox all = node.box.get(0);
    for (unsigned lane = 1; lane < node.children; ++lane)
        all.add(node.box.get(lane));
    return all;
}

void BoxTree::fit_subtree(const Subtree& subtree)
{
    std::vector<FloatBox> around(subtree.nodes);
    // Each node stands before its children, so going backwards finds the boxes of all children
    // ready.
    for (std::size_t i = subtree.nodes; i-- > 0;) {
        Node& n = nodes_[subtree.node + i];
        for (unsigned lane = 0; lane < n.children; ++lane) {
            const int child = n.child[lane];
            const FloatBox box =
                child < 0 ? around_leaf(leaf_of(child)) : around[std::size_t(child) - subtree.node];
            n.box.set(lane, box);
            lane == 0 ? void(around[i] = box) : around[i].add(box);
        }
    }
}

void BoxTree::fit_upper_nodes()
{
    for (std::size_t i = upper_.size(); i-- > 0;) {
        Node& n = nodes_[upper_[i]];
        for (unsigned lane = 0; lane < n.children; ++lane)
            n.box.set(lane, around(nodes_[static_cast<std::size_t>(n.child[lane])]));
    }
}

void BoxTree::Near::add(const FloatBox& box, int item)
{
    const std::size_t lane = item_.size() % kWide;
    if (lane == 0)
        // Places that are not used keep a box that overlaps nothing, so a query need not know how
        // many of the last block are used.
        block_.push_back(FourBoxes::none());
    block_.back().set(lane, box);
    item_.push_back(item);
}

bool BoxTree::list_overlaps_from(std::size_t place, const FloatBox& box, Near& near,
                                 std::size_t most) const
{
    near.clear();
    const FourBoxes wanted = FourBoxes::same(box);
    bool all = true;
    descend(
        [&](int four, const FourBoxes& boxes) {
            return end_of(four) > place ? boxes.overlaps(wanted) : 0U;
        },
        [&](std::size_t at) {
            all = near.size() < most;
            if (all)
                near.add(box_at(at), item_[at]);
            return all;
        });
    return all;
}

void BoxTree::mark(const std::vector<Marks>& marks)
{
    assert(marks.size() == item_.size());
    constexpr Marks kNone{kNoMark, kNoMark, kNoMark};
    own_.assign(kWide * leaves_.size(), kNone);
    for (std::size_t place = 0; place < item_.size(); ++place)
        own_[place] = marks[static_cast<std::size_t>(item_[place])];
    common_.assign(kWide * nodes_.size(), kNone);
    const auto common_of = [](const Marks* lanes, std::size_t count) {
        Marks common = lanes[0];
        for (std::uint32_t& mark : common)
            for (std::size_t lane = 1; lane < count; ++lane)
                if (std::find(lanes[lane].begin(), lanes[lane].end(), mark) == lanes[lane].end())
                    mark = kNoMark;
        return common;
    };
    // Children stand behind their node, as in fit_subtree().
    for (std::size_t i = nodes_.size(); i-- > 0;)
        for (unsigned lane = 0; lane < nodes_[i].children; ++lane) {
            const int child = nodes_[i].child[lane];
            common_[kWide * i + lane] =
                child < 0 ? common_of(&own_[kWide * leaf_of(child)],
                                      leaf_end(leaf_of(child)) - kWide * leaf_of(child))
                          : common_of(&common_[kWide * std::size_t(child)],
                                      nodes_[std::size_t(child)].children);
        }
}

} // namespace vdb_shell
