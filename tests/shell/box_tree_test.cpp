// SPDX-License-Identifier: Apache-2.0
#include "shell/grow/box_tree.h"

#include "core/counter_random.h"

#include <gtest/gtest.h>

namespace
{

using openvdb::Vec3d;
using vdb_shell::growth::Box;
using vdb_shell::growth::BoxTree;

std::vector<Box> random_boxes(int count, std::uint64_t seed)
{
    std::vector<Box> boxes(static_cast<std::size_t>(count));
    const vdb_shell::CounterRandom random(seed);
    for (std::size_t i = 0; i < boxes.size(); ++i)
        for (std::uint64_t corner = 0; corner < 2; ++corner) {
            Vec3d p;
            for (std::uint64_t k = 0; k < 3; ++k) {
                const double at = random.unit(9 * i + k);
                p[static_cast<int>(k)] = at + 0.1 * random.unit(9 * i + 3 + 3 * corner + k);
            }
            boxes[i].add(p);
        }
    return boxes;
}

void expect_same_as_all_pairs(const BoxTree& tree, const std::vector<Box>& boxes)
{
    for (std::size_t i = 0; i < boxes.size(); i += 7) {
        std::vector<int> found, expected;
        tree.for_each_overlap(boxes[i], [&](int k) { found.push_back(k); });
        for (std::size_t k = 0; k < boxes.size(); ++k)
            if (boxes[i].overlaps(boxes[k]))
                expected.push_back(static_cast<int>(k));
        std::sort(found.begin(), found.end());
        ASSERT_EQ(found, expected) << "query " << i << " of " << boxes.size();
    }
}

// Sizes around the leaves', and one that is built on several threads.
TEST(BoxTree, FindsWhatAllPairsFind)
{
    for (const int count : {1, 2, 4, 5, 8, 9, 10, 11, 17, 100, 9001}) {
        const std::vector<Box> boxes = random_boxes(count, 1);
        BoxTree tree;
        tree.build(boxes);
        expect_same_as_all_pairs(tree, boxes);
    }
}

TEST(BoxTree, FindsTheSameAfterItsBoxesHaveMoved)
{
    BoxTree tree;
    tree.build(random_boxes(500, 1));
    const std::vector<Box> moved = random_boxes(500, 2);
    tree.refit(moved);
    expect_same_as_all_pairs(tree, moved);
}

TEST(BoxTree, IsEmptyWithoutBoxes)
{
    BoxTree tree;
    tree.build({});
    tree.for_each_overlap(Box(), [](int) { FAIL(); });
}

} // namespace
