// SPDX-License-Identifier: Apache-2.0
#include "core/box_tree.h"

#include "core/parallel.h"

#include <tbb/parallel_invoke.h>

#include <cassert>
#include <limits>

namespace vdb_shell
{

namespace
{

constexpr int kLeaf = 4;
// Below this many boxes a second thread costs more than it saves.
constexpr int kParallel = 512;

/// How many nodes a tree over `count` boxes has. On each level there are two sizes at most, `size`
/// and `size` + 1.
int node_count(int count)
{
    int size = count, of_size = 1, of_more = 0, nodes = 0;
    while (true) {
        nodes += of_size + of_more;
        if (size + 1 <= kLeaf)
            return nodes;
        if (size <= kLeaf)
            return nodes + 2 * of_more;
        if (size % 2 == 0)
            of_size = 2 * of_size + of_more;
        else
            of_more = of_size + 2 * of_more;
        size /= 2;
    }
}

} // namespace

/// What the splits move: a box by its middle.
struct BoxTree::Item {
    std::array<float, 3> twice_middle;
    int box;
};

bool FloatBox::meets_ray(const openvdb::Vec3d& p, const openvdb::Vec3d& d, double limit) const
{
    constexpr double kAboveRounding = 1 + 1e-9, kLeast = 1e-300;
    double from = 0, to = limit;
    for (int k = 0; k < 3; ++k) {
        const auto low = double(lo[k]), high = double(hi[k]);
        if (d[k] == 0) {
            if (p[k] < low || p[k] > high)
                return false;
            continue;
        }
        const double a = (low - p[k]) / d[k], b = (high - p[k]) / d[k];
        from = std::max(from, std::min(a, b)), to = std::min(to, std::max(a, b));
    }
    return from <= to * kAboveRounding + kLeast;
}

void BoxTree::build(std::vector<FloatBox> boxes)
{
    const std::size_t count = boxes.size();
    nodes_.clear();
    item_.resize(count);
    boxes_.resize(count);
    if (count == 0)
        return;
    std::vector<Item> items(count);
    for_each_index(
        count,
        [&](std::size_t i) {
            const FourFloats sum = boxes[i].lo + boxes[i].hi;
            items[i] = {{sum[0], sum[1], sum[2]}, static_cast<int>(i)};
        },
        1024);
    nodes_.resize(static_cast<std::size_t>(node_count(static_cast<int>(count))));
    split(items, 0, 0, static_cast<int>(count));
    for_each_index(
        count,
        [&](std::size_t i) {
            item_[i] = items[i].box;
            boxes_[i] = boxes[static_cast<std::size_t>(items[i].box)];
        },
        1024);
    fit_nodes();
}

void BoxTree::split(std::vector<Item>& items, int id, int begin, int end)
{
    Node& node = nodes_[static_cast<std::size_t>(id)];
    node.begin = begin, node.end = end, node.right = -1;
    if (end - begin <= kLeaf)
        return;
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
    const int middle = begin + (end - begin) / 2;
    // Ties by index: the tree, and with it the order of all candidate lists, is the same
    // everywhere.
    std::nth_element(first, items.begin() + middle, last, [axis](const Item& a, const Item& b) {
        const float ca = a.twice_middle[axis], cb = b.twice_middle[axis];
        return ca != cb ? ca < cb : a.box < b.box;
    });
    const int left = id + 1, right = left + node_count(middle - begin);
    node.right = right;
    if (end - begin < kParallel) {
        split(items, left, begin, middle);
        split(items, right, middle, end);
        return;
    }
    tbb::parallel_invoke([&] { split(items, left, begin, middle); },
                         [&] { split(items, right, middle, end); });
}

void BoxTree::refit(const std::vector<FloatBox>& boxes, const std::vector<std::uint8_t>& changed)
{
    assert(boxes.size() == boxes_.size());
    for_each_index(
        boxes.size(),
        [&](std::size_t i) {
            const auto item = static_cast<std::size_t>(item_[i]);
            if (changed.empty() || changed[item])
                boxes_[i] = boxes[item];
        },
        1024);
    fit_nodes();
}

void BoxTree::fit_nodes()
{
    // Children stand behind their parents.
    for (std::size_t i = nodes_.size(); i-- > 0;) {
        Node& n = nodes_[i];
        if (n.right >= 0) {
            n.box = nodes_[i + 1].box;
            n.box.add(nodes_[static_cast<std::size_t>(n.right)].box);
            continue;
        }
        n.box = boxes_[static_cast<std::size_t>(n.begin)];
        for (int k = n.begin; k < n.end; ++k)
            n.box.add(boxes_[static_cast<std::size_t>(k)]);
    }
}

void BoxTree::Near::add(const FloatBox& box, int item)
{
    const std::size_t lane = item_.size() % kInBlock;
    if (lane == 0) {
        // What is not there overlaps nothing.
        const FourFloats none = four(std::numeric_limits<float>::quiet_NaN());
        block_.push_back({{none, none, none}, {none, none, none}});
    }
    for (std::size_t k = 0; k < 3; ++k) {
        block_.back().lo[k][lane] = box.lo[k];
        block_.back().hi[k][lane] = box.hi[k];
    }
    item_.push_back(item);
}

void BoxTree::list_overlaps(const FloatBox& box, Near& near) const
{
    near.clear();
    descend([&](const FloatBox& other) { return box.overlaps(other); },
            [&](std::size_t at) { near.add(boxes_[at], item_[at]); });
}

} // namespace vdb_shell
