// SPDX-License-Identifier: Apache-2.0
#include "core/box_pairs.h"

#include "core/bucket_sort.h"
#include "core/parallel.h"

#include <algorithm>

namespace vdb_shell
{
namespace
{

using Pair = std::array<std::uint32_t, 2>;

constexpr std::size_t kGroupsInPart = 16;

} // namespace

std::vector<FloatBox> triangle_boxes(const std::vector<openvdb::Vec3s>& points,
                                     const std::vector<openvdb::Vec3I>& triangles)
{
    std::vector<FloatBox> boxes(triangles.size());
    for_each_index(triangles.size(), [&](std::size_t t) {
        FloatBox box = FloatBox::around(points[triangles[t][0]]);
        for (int corner = 1; corner < 3; ++corner)
            box.add(points[triangles[t][corner]]);
        boxes[t] = box;
    });
    return boxes;
}

std::vector<Pair> overlapping_pairs(const std::vector<FloatBox>& boxes)
{
    return overlapping_pairs(boxes, [](std::uint32_t, std::uint32_t) { return true; });
}

std::vector<Pair> overlapping_pairs(const std::vector<FloatBox>& boxes, const KeepPair& keep)
{
    BoxTree tree;
    tree.build(boxes);
    const std::size_t groups = tree.groups();
    std::vector<std::vector<Pair>> parts((groups + kGroupsInPart - 1) / kGroupsInPart);
    for_each_index(
        parts.size(),
        [&](std::size_t part) {
            BoxTree::Near near;
            const std::size_t end = std::min(groups, (part + 1) * kGroupsInPart);
            for (std::size_t group = part * kGroupsInPart; group < end; ++group)
                tree.for_each_overlap_of(
                    group, tree, near, [](int) { return true; },
                    [&](int i, int j) {
                        const auto low = static_cast<std::uint32_t>(i),
                                   high = static_cast<std::uint32_t>(j);
                        if (low < high && keep(low, high))
                            parts[part].push_back({low, high});
                    });
        },
        1);
    return bucket_sort<Pair>(
        parts, boxes.size(), [](const Pair& pair) { return pair[0]; },
        [](const Pair& x, const Pair& y) { return x[1] < y[1]; });
}

} // namespace vdb_shell
