// SPDX-License-Identifier: Apache-2.0

// All pairs of boxes with a common point: the candidates of every test for contacts. It takes
// closed boxes in float32 and leaves the pairs i < j, sorted, each once. Nothing is rounded, so no
// pair is missed, however the boxes touch. The result is the same for any number of threads: each
// part of the tree's groups fills a list of its own, and a bucket sort puts the lists into one
// order that does not depend on them. Traps: `keep` is called from several threads at a time and in
// no particular order; many boxes in one place give quadratically many pairs.

#include "core/box_pairs.h"

#include "core/bucket_sort.h"
#include "core/parallel.h"
#include "core/polled_stop.h"

#include <algorithm>

namespace vdb_shell
{
namespace
{

using Pair = std::array<std::uint32_t, 2>;

// Groups that one thread takes at a time: they share the memory of one list of nearby boxes.
constexpr std::size_t kGroupsInPart = 16;

} // namespace

FloatBox triangle_box(const std::vector<openvdb::Vec3s>& points, const openvdb::Vec3I& triangle)
{
    FloatBox box = FloatBox::around(points[triangle[0]]);
    for (int corner = 1; corner < 3; ++corner)
        box.add(points[triangle[corner]]);
    return box;
}

std::vector<FloatBox> triangle_boxes(const std::vector<openvdb::Vec3s>& points,
                                     const std::vector<openvdb::Vec3I>& triangles)
{
    std::vector<FloatBox> boxes(triangles.size());
    for_each_index(triangles.size(),
                   [&](std::size_t t) { boxes[t] = triangle_box(points, triangles[t]); });
    return boxes;
}

std::vector<Pair> overlapping_pairs(const std::vector<FloatBox>& boxes)
{
    return overlapping_pairs(boxes, [](std::uint32_t, std::uint32_t) { return true; });
}

std::vector<Pair> overlapping_pairs(const std::vector<FloatBox>& boxes, const KeepPair& keep,
                                    Interrupter* interrupter)
{
    const PolledStop stop(interrupter);
    BoxTree tree;
    tree.build(boxes);
    const std::size_t groups = tree.groups();
    std::vector<std::vector<Pair>> parts((groups + kGroupsInPart - 1) / kGroupsInPart);
    for_each_index(
        parts.size(),
        [&](std::size_t part) {
            BoxTree::Near near;
            const std::size_t end = std::min(groups, (part + 1) * kGroupsInPart);
            for (std::size_t group = part * kGroupsInPart; group < end && !stop.wanted(); ++group)
                tree.for_each_pair_of(group, near, [&](int i, int j) {
                    const auto low = static_cast<std::uint32_t>(std::min(i, j)),
                               high = static_cast<std::uint32_t>(std::max(i, j));
                    // What `keep` rejects is dropped here, before it takes memory.
                    if (keep(low, high))
                        parts[part].push_back({low, high});
                });
        },
        1);
    stop.throw_if_wanted();
    // The first boxes are numbers from 0 without gaps, as a bucket sort wants. The second tells all
    // pairs of a bucket apart, so their order is unique.
    return bucket_sort<Pair>(
        parts, boxes.size(), [](const Pair& pair) { return pair[0]; },
        [](const Pair& x, const Pair& y) { return x[1] < y[1]; });
}

} // namespace vdb_shell
