// SPDX-License-Identifier: Apache-2.0
#include "shell/grow/box_tree.h"

#include <tbb/parallel_invoke.h>

#include <cassert>
#include <numeric>
#include <utility>

namespace vdb_shell::growth
{

namespace
{

constexpr int kLeaf = 4;
// Below this many boxes a second thread costs more than it saves.
constexpr int kParallel = 4096;

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

void BoxTree::build(std::vector<Box> boxes)
{
    boxes_ = std::move(boxes);
    const int count = static_cast<int>(boxes_.size());
    item_.resize(boxes_.size());
    std::iota(item_.begin(), item_.end(), 0);
    nodes_.clear();
    if (boxes_.empty())
        return;
    nodes_.resize(static_cast<std::size_t>(node_count(count)));
    split(0, 0, count);
}

void BoxTree::split(int id, int begin, int end)
{
    Box all, centres;
    for (int i = begin; i < end; ++i) {
        const Box& b = boxes_[item_[i]];
        all.add(b);
        centres.add(b.lo + b.hi);
    }
    nodes_[id] = {all, begin, end, -1};
    if (end - begin <= kLeaf)
        return;
    const Vec3d size = centres.hi - centres.lo;
    const int axis = size[0] >= size[1] && size[0] >= size[2] ? 0 : size[1] >= size[2] ? 1 : 2;
    const int middle = begin + (end - begin) / 2;
    // Ties by index: the tree, and with it the order of all candidate lists, is the same
    // everywhere.
    std::nth_element(item_.begin() + begin, item_.begin() + middle, item_.begin() + end,
                     [&](int a, int b) {
                         const double ca = boxes_[a].lo[axis] + boxes_[a].hi[axis];
                         const double cb = boxes_[b].lo[axis] + boxes_[b].hi[axis];
                         return ca != cb ? ca < cb : a < b;
                     });
    const int left = id + 1, right = left + node_count(middle - begin);
    nodes_[id].right = right;
    if (end - begin < kParallel) {
        split(left, begin, middle);
        split(right, middle, end);
        return;
    }
    tbb::parallel_invoke([&] { split(left, begin, middle); }, [&] { split(right, middle, end); });
}

void BoxTree::refit(std::vector<Box> boxes)
{
    assert(boxes.size() == boxes_.size());
    boxes_ = std::move(boxes);
    // Children stand behind their parents.
    for (std::size_t i = nodes_.size(); i-- > 0;) {
        Node& n = nodes_[i];
        n.box = Box();
        if (n.right >= 0) {
            n.box.add(nodes_[i + 1].box);
            n.box.add(nodes_[n.right].box);
        } else
            for (int k = n.begin; k < n.end; ++k)
                n.box.add(boxes_[item_[k]]);
    }
}

} // namespace vdb_shell::growth
