// SPDX-License-Identifier: Apache-2.0
#include "core/box_tree.h"

#include "core/counter_random.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace
{

using openvdb::Vec3s;
using vdb_shell::BoxTree;
using vdb_shell::FloatBox;

std::vector<FloatBox> random_boxes(int count, std::uint64_t seed)
{
    std::vector<FloatBox> boxes(static_cast<std::size_t>(count));
    const vdb_shell::CounterRandom random(seed);
    const auto corner_of = [&](std::size_t i, std::uint64_t corner) {
        Vec3s p;
        for (std::uint64_t k = 0; k < 3; ++k)
            p[int(k)] = static_cast<float>(random.unit(9 * i + k) +
                                           0.1 * random.unit(9 * i + 3 + 3 * corner + k));
        return p;
    };
    for (std::size_t i = 0; i < boxes.size(); ++i) {
        boxes[i] = FloatBox::around(corner_of(i, 0));
        boxes[i].add(corner_of(i, 1));
    }
    return boxes;
}

void expect_overlaps(std::vector<int> found, const std::vector<FloatBox>& boxes, std::size_t query)
{
    std::vector<int> wanted;
    for (std::size_t k = 0; k < boxes.size(); ++k) {
        bool common = true;
        for (int axis = 0; axis < 3; ++axis)
            common = common && boxes[query].lo[axis] <= boxes[k].hi[axis] &&
                     boxes[k].lo[axis] <= boxes[query].hi[axis];
        if (common)
            wanted.push_back(static_cast<int>(k));
    }
    std::sort(found.begin(), found.end());
    EXPECT_EQ(found, wanted) << "query " << query << " of " << boxes.size();
}

void expect_same_as_all_pairs(const BoxTree& tree, const std::vector<FloatBox>& boxes)
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
    for (const int count : {1, 2, 4, 5, 6, 8, 9, 10, 11, 16, 17, 20, 21, 33, 63, 65, 100, 9001}) {
        const std::vector<FloatBox> boxes = random_boxes(count, 1);
        BoxTree tree;
        tree.build(boxes);
        expect_same_as_all_pairs(tree, boxes);
    }
}

TEST(BoxTree, AGroupFindsWhatItsBoxesFindOneByOne)
{
    const auto wanted = [](int i) { return i % 3 != 0; };
    for (const int count : {1, 15, 16, 17, 500}) {
        const std::vector<FloatBox> boxes = random_boxes(count, 1);
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

TEST(BoxTree, FindsEachPairOnceFromItsGroups)
{
    for (const int count : {1, 4, 16, 17, 65, 1000}) {
        const std::vector<FloatBox> boxes = random_boxes(count, 4);
        BoxTree tree;
        tree.build(boxes);
        BoxTree::Near near;
        std::vector<std::array<int, 2>> found, wanted;
        std::size_t refused = 0;
        for (std::size_t group = 0; group < tree.groups(); ++group) {
            EXPECT_TRUE(tree.for_each_pair_of(group, near, [&](int i, int j) {
                found.push_back({std::min(i, j), std::max(i, j)});
            }));
            refused += !tree.for_each_pair_of(
                group, near, [](int, int) { FAIL() << "no pair"; }, 0);
        }
        EXPECT_EQ(refused, tree.groups()) << "each holds itself at least";
        for (int i = 0; i < count; ++i)
            for (int j = i + 1; j < count; ++j)
                if (boxes[std::size_t(i)].overlaps(boxes[std::size_t(j)]))
                    wanted.push_back({i, j});
        std::sort(found.begin(), found.end());
        EXPECT_EQ(found, wanted) << count;
    }
}

TEST(BoxTree, FindsTheSameAfterItsBoxesHaveMoved)
{
    // The larger one has nodes above what one thread takes.
    for (const int count : {500, 9001}) {
        BoxTree tree;
        tree.build(random_boxes(count, 1));
        const std::vector<FloatBox> moved = random_boxes(count, 2);
        tree.refit(moved);
        expect_same_as_all_pairs(tree, moved);
    }
}

TEST(BoxTree, LooksOnlyAtBoxesThatAreSaidToHaveChanged)
{
    const std::vector<FloatBox> before = random_boxes(500, 1), elsewhere = random_boxes(500, 2);
    BoxTree tree;
    tree.build(before);
    std::vector<std::uint8_t> changed(before.size(), 0);
    std::vector<FloatBox> now = before;
    for (std::size_t i = 0; i < now.size(); i += 3) {
        changed[i] = 1;
        now[i] = elsewhere[i];
    }
    tree.refit(elsewhere, changed);
    expect_same_as_all_pairs(tree, now);
}

// Through the middle of each box, and away from it.
/// Changes every so-manyth box, in the tree and in the list.
template <class Change> void expect_same_after_changes(std::size_t step, const Change& change)
{
    std::vector<FloatBox> boxes = random_boxes(700, 5);
    const std::vector<FloatBox> others = random_boxes(700, 6);
    BoxTree tree;
    tree.build(boxes);
    tree.index_parents();
    for (std::size_t i = 0; i < boxes.size(); i += step)
        change(tree, i, boxes[i], others[i]);
    expect_same_as_all_pairs(tree, boxes);
}

TEST(BoxTree, FindsBoxesWhereTheyHaveBeenPutOneByOne)
{
    expect_same_after_changes(
        3, [](BoxTree& tree, std::size_t i, FloatBox& box, const FloatBox& there) {
            box = there;
            tree.replace(i, there);
        });
}

TEST(BoxTree, FindsBoxesByAllThatTheyHaveBeenWidenedBy)
{
    expect_same_after_changes(
        7, [](BoxTree& tree, std::size_t i, FloatBox& box, const FloatBox& more) {
            box.add(more);
            tree.widen(i, more);
        });
}

// Marks of boxes that lie together are passed over together, wherever they stand among the three.
TEST(BoxTree, LeavesOutBoxesThatCarryAMark)
{
    for (const int count : {3, 21, 700}) {
        const std::vector<FloatBox> boxes = random_boxes(count, 7);
        std::vector<BoxTree::Marks> marks(boxes.size());
        for (std::size_t i = 0; i < marks.size(); ++i) {
            const auto half = std::uint32_t(boxes[i].lo[0] < 0.5F), tenth = std::uint32_t(i % 10);
            marks[i] = {i % 2 == 0 ? half : tenth + 2, BoxTree::kNoMark,
                        i % 2 == 0 ? tenth + 2 : half};
        }
        BoxTree tree;
        tree.build(boxes);
        tree.mark(marks);
        const BoxTree::Marks unwanted{5, 0, BoxTree::kNoMark};
        for (const FloatBox& query : boxes) {
            std::vector<int> found, expected;
            tree.for_each_overlap_without(unwanted, query, [&](int i) {
                found.push_back(i);
                return true;
            });
            for (std::size_t i = 0; i < boxes.size(); ++i)
                if (boxes[i].overlaps(query) && !BoxTree::have_common(unwanted, marks[i]))
                    expected.push_back(int(i));
            std::sort(found.begin(), found.end());
            EXPECT_EQ(found, expected);
        }
    }
}

TEST(BoxTree, FindsTheBoxesOnARayAndNoneBehindIt)
{
    const std::vector<FloatBox> boxes = random_boxes(300, 4);
    BoxTree tree;
    tree.build(boxes);
    const openvdb::Vec3d from(-1.0, 0.4, 0.3);
    for (std::size_t i = 0; i < boxes.size(); ++i) {
        openvdb::Vec3d way;
        for (int k = 0; k < 3; ++k)
            way[k] = 0.5 * (double(boxes[i].lo[k]) + double(boxes[i].hi[k])) - from[k];
        const double middle = 1.0, short_of_all = 0.5;
        bool found = false;
        tree.for_each_on_ray(from, way, middle, [&](int k) { found |= k == static_cast<int>(i); });
        EXPECT_TRUE(found) << i;
        tree.for_each_on_ray(from, -way, middle, [](int k) { ADD_FAILURE() << "behind: " << k; });
        tree.for_each_on_ray(from, way * short_of_all, short_of_all,
                             [](int k) { ADD_FAILURE() << "too far: " << k; });
    }
}

TEST(BoxTree, IsEmptyWithoutBoxes)
{
    BoxTree tree;
    tree.build({});
    tree.for_each_overlap(FloatBox{}, [](int) { FAIL(); });
}

// A wall of boxes behind each other: once the first is found the others are beyond the limit.
TEST(BoxTree, ARayThatEndsAtTheNearestBoxSeesFewOthers)
{
    constexpr int kWalls = 100, kAcross = 10;
    std::vector<FloatBox> boxes;
    for (int wall = 0; wall < kWalls; ++wall)
        for (int i = 0; i < kAcross * kAcross; ++i) {
            const Vec3s low(float(wall), float(i / kAcross), float(i % kAcross));
            boxes.push_back(FloatBox::around(low));
            boxes.back().add(low + Vec3s(0.125F, 1, 1));
        }
    BoxTree tree;
    tree.build(boxes);
    // From either end.
    for (const double from : {-1.0, kWalls + 1.0}) {
        const openvdb::Vec3d start(from, 4.5, 4.5), way(from < 0 ? 1 : -1, 0.001, 0.002);
        double limit = 1e9;
        int seen = 0;
        tree.for_each_on_ray(start, way, limit, [&](int i) {
            ++seen;
            const FloatBox& box = boxes[std::size_t(i)];
            const double face = double(from < 0 ? box.lo[0] : box.hi[0]);
            limit = std::min(limit, std::abs(face - from));
        });
        EXPECT_EQ(limit, from < 0 ? 1 : 1.875);
        EXPECT_LE(seen, 8);
    }
}

} // namespace
