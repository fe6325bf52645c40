// SPDX-License-Identifier: Apache-2.0
#include "core/box_pairs.h"

#include "support/shapes.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>
#include <random>

namespace vdb_shell
{
namespace
{

using openvdb::Vec3s;
using Pairs = std::vector<std::array<std::uint32_t, 2>>;

Pairs by_brute_force(const std::vector<Box>& boxes)
{
    Pairs pairs;
    for (std::uint32_t i = 0; i < boxes.size(); ++i)
        for (std::uint32_t j = i + 1; j < boxes.size(); ++j) {
            bool common = true;
            for (int axis = 0; axis < 3; ++axis)
                common = common && boxes[i].low[axis] <= boxes[j].high[axis] &&
                         boxes[j].low[axis] <= boxes[i].high[axis];
            if (common)
                pairs.push_back({i, j});
        }
    return pairs;
}

std::vector<Box> random_boxes(std::size_t count)
{
    std::mt19937 random(7);
    // Whole numbers, so that many boxes only touch, and some have no thickness.
    std::uniform_int_distribution<int> place(0, 30), size(0, 3);
    std::vector<Box> boxes(count);
    for (Box& box : boxes)
        for (int axis = 0; axis < 3; ++axis) {
            box.low[axis] = float(place(random));
            box.high[axis] = box.low[axis] + float(size(random));
        }
    return boxes;
}

TEST(overlapping_pairs, agree_with_all_pairs_tried)
{
    for (const std::size_t count : {0U, 1U, 2U, 3U, 100U, 2000U}) {
        const std::vector<Box> boxes = random_boxes(count);
        EXPECT_EQ(overlapping_pairs(boxes), by_brute_force(boxes)) << count;
    }
}

TEST(overlapping_pairs, tell_the_last_bit)
{
    const float past = std::nextafter(1.0F, 2.0F);
    const std::vector<Box> boxes{{Vec3s(0), Vec3s(1)},
                                 {Vec3s(1, 0, 0), Vec3s(2, 1, 1)},
                                 {Vec3s(past, 0, 0), Vec3s(2, 1, 1)}};
    const Pairs pairs = overlapping_pairs(boxes);
    EXPECT_EQ(pairs, (Pairs{{0, 1}, {1, 2}}));
}

TEST(overlapping_pairs, find_equal_boxes_and_boxes_far_away)
{
    EXPECT_EQ(overlapping_pairs(std::vector<Box>(20, {Vec3s(1), Vec3s(2)})).size(), 190U);
    const std::vector<Box> far{{Vec3s(1e15F), Vec3s(2e15F)}, {Vec3s(2e15F), Vec3s(3e15F)}};
    EXPECT_EQ(overlapping_pairs(far), (Pairs{{0, 1}}));
}

TEST(overlapping_pairs, do_not_depend_on_the_number_of_threads)
{
    const std::vector<Box> boxes = random_boxes(5000);
    const Pairs wanted = overlapping_pairs(boxes);
    for (const std::size_t threads : {1U, 2U, 7U}) {
        const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
        EXPECT_EQ(overlapping_pairs(boxes), wanted);
    }
}

TEST(triangle_boxes, are_tight)
{
    const TriangleMesh mesh = test::unit_tetrahedron();
    const std::vector<Box> boxes = triangle_boxes(mesh.points, mesh.triangles);
    ASSERT_EQ(boxes.size(), 4U);
    EXPECT_EQ(boxes[0].low, Vec3s(0));
    EXPECT_EQ(boxes[0].high, Vec3s(1, 1, 0));
    EXPECT_EQ(boxes[3].high, Vec3s(1));
}

} // namespace
} // namespace vdb_shell
