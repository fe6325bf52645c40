// SPDX-License-Identifier: Apache-2.0
#include "shell/grow/box_tree.h"

#include <numeric>
#include <utility>

namespace vdb_shell::growth
{

void BoxTree::build(std::vector<Box> boxes)
{
    boxes_ = std::move(boxes);
    item_.resize(boxes_.size());
    std::iota(item_.begin(), item_.end(), 0);
    nodes_.clear();
    if (!boxes_.empty())
        split(0, static_cast<int>(boxes_.size()));
}

int BoxTree::split(int begin, int end)
{
    constexpr int kLeaf = 4;
    const int id = static_cast<int>(nodes_.size());
    Box all, centres;
    for (int i = begin; i < end; ++i) {
        const Box& b = boxes_[item_[i]];
        all.add(b);
        centres.add(b.lo + b.hi);
    }
    nodes_.push_back({all, begin, end, -1});
    if (end - begin <= kLeaf)
        return id;
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
    split(begin, middle);
    const int right = split(middle, end);
    nodes_[id].right = right;
    return id;
}

} // namespace vdb_shell::growth
