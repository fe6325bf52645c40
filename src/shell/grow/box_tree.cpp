// SPDX-License-Identifier: Apache-2.0
#include "shell/grow/box_tree.h"

#include "core/parallel.h"

#include <tbb/parallel_invoke.h>

#include <cassert>
#include <cmath>
#include <limits>
#include <numeric>

namespace vdb_shell::growth
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

FloatBox float_box(const Box& box)
{
    constexpr float kMost = std::numeric_limits<float>::max();
    FloatBox out{four(-kMost), four(kMost)};
    for (int k = 0; k < 3; ++k) {
        const auto lo = static_cast<float>(box.lo[k]), hi = static_cast<float>(box.hi[k]);
        out.lo[k] = double(lo) <= box.lo[k] ? lo : std::nextafter(lo, -kMost);
        out.hi[k] = double(hi) >= box.hi[k] ? hi : std::nextafter(hi, kMost);
    }
    return out;
}

void BoxTree::build(const std::vector<Box>& boxes)
{
    const int count = static_cast<int>(boxes.size());
    item_.resize(boxes.size());
    std::iota(item_.begin(), item_.end(), 0);
    nodes_.clear();
    boxes_.resize(boxes.size());
    if (boxes.empty())
        return;
    for_each_index(
        boxes.size(), [&](std::size_t i) { boxes_[i] = float_box(boxes[i]); }, 1024);
    nodes_.resize(static_cast<std::size_t>(node_count(count)));
    split(0, 0, count);
    refit(boxes);
}

/// With boxes_ still in the order of the boxes given.
void BoxTree::split(int id, int begin, int end)
{
    Node& node = nodes_[static_cast<std::size_t>(id)];
    node.begin = begin, node.end = end, node.right = -1;
    if (end - begin <= kLeaf)
        return;
    const auto centre = [&](int item) { return boxes_[item].lo + boxes_[item].hi; };
    FourFloats low = centre(item_[begin]), high = low;
    for (int i = begin; i < end; ++i) {
        const FourFloats c = centre(item_[i]);
        low = least_of(low, c), high = most_of(high, c);
    }
    const FourFloats size = high - low;
    const int axis = size[0] >= size[1] && size[0] >= size[2] ? 0 : size[1] >= size[2] ? 1 : 2;
    const int middle = begin + (end - begin) / 2;
    // Ties by index: the tree, and with it the order of all candidate lists, is the same
    // everywhere.
    std::nth_element(item_.begin() + begin, item_.begin() + middle, item_.begin() + end,
                     [&](int a, int b) {
                         const float ca = centre(a)[axis], cb = centre(b)[axis];
                         return ca != cb ? ca < cb : a < b;
                     });
    const int left = id + 1, right = left + node_count(middle - begin);
    node.right = right;
    if (end - begin < kParallel) {
        split(left, begin, middle);
        split(right, middle, end);
        return;
    }
    tbb::parallel_invoke([&] { split(left, begin, middle); }, [&] { split(right, middle, end); });
}

void BoxTree::refit(const std::vector<Box>& boxes, const std::vector<std::uint8_t>& changed)
{
    assert(boxes.size() == boxes_.size());
    for_each_index(
        boxes.size(),
        [&](std::size_t i) {
            const auto item = static_cast<std::size_t>(item_[i]);
            if (changed.empty() || changed[item])
                boxes_[i] = float_box(boxes[item]);
        },
        1024);
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

} // namespace vdb_shell::growth
