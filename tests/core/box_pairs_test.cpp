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

FloatBox box_between(const Vec3s& low, const Vec3s& high)
{
    FloatBox box = FloatBox::around(low);
    box.add(high);
    return box;
}

Pairs by_brute_force(const std::vector<FloatBox>& boxes)
{
    Pairs pairs;
    for (std::uint32_t i = 0; i < boxes.size(); ++i)
        for (std::uint32_t j = i + 1; j < boxes.size(); ++j) {
            bool common = true;
            for (int axis = 0; axis < 3; ++axis)
                common = common && boxes[i].lo[axis] <= boxes[j].hi[axis] &&
                         boxes[j].lo[axis] <= boxes[i].hi[axis];
            if (common)
                pairs.push_back({i, j});
        }
    return pairs;
}

std::vector<FloatBox> random_boxes(std::size_t count)
{
    std::mt19937 random(7);
    // Whole numbers, so that many boxes only touch, and some have no thickness.
    std::uniform_int_distribution<int> place(0, 30), size(0, 3);
    std::vector<FloatBox> boxes(count);
    for (FloatBox& box : boxes)
        for (int axis = 0; axis < 3; ++axis) {
            box.lo[axis] = float(place(random));
            box.hi[axis] = box.lo[axis] + float(size(random));
        }
    return boxes;
}

TEST(overlapping_pairs, agree_with_all_pairs_tried)
{
    for (const std::size_t count : {0U, 1U, 2U, 3U, 100U, 2000U}) {
        const std::vector<FloatBox> boxes = random_boxes(count);
        EXPECT_EQ(overlapping_pairs(boxes), by_brute_force(boxes)) << count;
    }
}

TEST(overlapping_pairs, tell_the_last_bit)
{
    const float past = std::nextafter(1.0F, 2.0F);
    const std::vector<FloatBox> boxes{box_between(Vec3s(0), Vec3s(1)),
                                      box_between(Vec3s(1, 0, 0), Vec3s(2, 1, 1)),
                                      box_between(Vec3s(past, 0, 0), Vec3s(2, 1, 1))};
    const Pairs pairs = overlapping_pairs(boxes);
    EXPECT_EQ(pairs, (Pairs{{0, 1}, {1, 2}}));
}

TEST(overlapping_pairs, find_equal_boxes_and_boxes_far_away)
{
    EXPECT_EQ(overlapping_pairs(std::vector<FloatBox>(20, box_between(Vec3s(1), Vec3s(2)))).size(),
              190U);
    const std::vector<FloatBox> far{box_between(Vec3s(1e15F), Vec3s(2e15F)),
                                    box_between(Vec3s(2e15F), Vec3s(3e15F))};
    EXPECT_EQ(overlapping_pairs(far), (Pairs{{0, 1}}));
}

TEST(overlapping_pairs, do_not_depend_on_the_number_of_threads)
{
    const std::vector<FloatBox> boxes = random_boxes(5000);
    const Pairs wanted = overlapping_pairs(boxes);
    for (const std::size_t threads : {1U, 2U, 7U}) {
        const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
        EXPECT_EQ(overlapping_pairs(boxes), wanted);
    }
}

TEST(triangle_boxes, are_tight)
{
    const TriangleMesh mesh = test::unit_tetrahedron();
    const std::vector<FloatBox> boxes = triangle_boxes(mesh.points, mesh.triangles);
    ASSERT_EQ(boxes.size(), 4U);
    const auto place = [](const FourFloats& at) { return Vec3s(at[0], at[1], at[2]); };
    EXPECT_EQ(place(boxes[0].lo), Vec3s(0));
    EXPECT_EQ(place(boxes[0].hi), Vec3s(1, 1, 0));
    EXPECT_EQ(place(boxes[3].hi), Vec3s(1));
}

} // namespace
} // namespace vdb_shell
