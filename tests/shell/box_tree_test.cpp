// SPDX-License-Identifier: Apache-2.0
#include "shell/grow/box_tree.h"

#include "core/counter_random.h"

#include <gtest/gtest.h>

#include <algorithm>

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

/// All that overlap, and besides these at most what does so once it has grown by a float's
/// rounding.
void expect_overlaps(std::vector<int> found, const std::vector<Box>& boxes, std::size_t query)
{
    constexpr double kRounding = 1e-6; // of coordinates below 2
    Box wide = boxes[query];
    wide.inflate(kRounding);
    std::sort(found.begin(), found.end());
    EXPECT_EQ(std::adjacent_find(found.begin(), found.end()), found.end()) << "query " << query;
    for (std::size_t k = 0; k < boxes.size(); ++k) {
        const bool there = std::binary_search(found.begin(), found.end(), static_cast<int>(k));
        if (boxes[query].overlaps(boxes[k])) {
            EXPECT_TRUE(there) << "query " << query << ", box " << k << " of " << boxes.size();
        }
        if (!wide.overlaps(boxes[k])) {
            EXPECT_FALSE(there) << "query " << query << ", box " << k << " of " << boxes.size();
        }
    }
}

void expect_same_as_all_pairs(const BoxTree& tree, const std::vector<Box>& boxes)
{
    for (std::size_t i = 0; i < boxes.size(); i += 7) {
        std::vector<int> found;
        tree.for_each_overlap(boxes[i], [&](int k) { found.push_back(k); });
        expect_overlaps(found, boxes, i);
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

TEST(BoxTree, AGroupFindsWhatItsBoxesFindOneByOne)
{
    const auto wanted = [](int i) { return i % 3 != 0; };
    for (const int count : {1, 15, 16, 17, 500}) {
        const std::vector<Box> boxes = random_boxes(count, 1);
        BoxTree tree;
        tree.build(boxes);
        std::vector<std::vector<int>> found(boxes.size());
        BoxTree::Near near;
        for (std::size_t group = 0; group < tree.groups(); ++group)
            tree.for_each_overlap_of(group, tree, near, wanted, [&](int i, int k) {
                found[static_cast<std::size_t>(i)].push_back(k);
            });
        for (std::size_t i = 0; i < boxes.size(); ++i) {
            if (wanted(static_cast<int>(i)))
                expect_overlaps(found[i], boxes, i);
            else
                EXPECT_TRUE(found[i].empty()) << i;
        }
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

TEST(BoxTree, LooksOnlyAtBoxesThatAreSaidToHaveChanged)
{
    const std::vector<Box> before = random_boxes(500, 1), elsewhere = random_boxes(500, 2);
    BoxTree tree;
    tree.build(before);
    std::vector<std::uint8_t> changed(before.size(), 0);
    std::vector<Box> now = before;
    for (std::size_t i = 0; i < now.size(); i += 3) {
        changed[i] = 1;
        now[i] = elsewhere[i];
    }
    tree.refit(elsewhere, changed);
    expect_same_as_all_pairs(tree, now);
}

TEST(BoxTree, IsEmptyWithoutBoxes)
{
    BoxTree tree;
    tree.build({});
    tree.for_each_overlap(Box(), [](int) { FAIL(); });
}

} // namespace
