// SPDX-License-Identifier: Apache-2.0
#include "core/triangle_piece.h"

#include <gtest/gtest.h>

#include <random>

namespace vdb_shell
{
namespace
{

using openvdb::Vec3d;
using openvdb::Vec3I;
using openvdb::Vec3s;

TEST(part_boxes, cover_every_point_of_a_needle_with_little_room)
{
    const std::vector<Vec3s> points{{0, 0, 0}, {7, 8, 9}, {7, 8, 9.01F}};
    const PartBoxes parts = part_boxes(points, {{0, 1, 2}});
    EXPECT_GT(parts.boxes.size(), 8u);
    std::mt19937 random(3);
    std::uniform_real_distribution<double> share(0, 1);
    for (int i = 0; i < 1000; ++i) {
        const double u = share(random), v = share(random) * (1 - u);
        const Vec3s p(Vec3d(points[1]) * u + Vec3d(points[2]) * v);
        EXPECT_TRUE(std::any_of(parts.boxes.begin(), parts.boxes.end(),
                                [&](const FloatBox& box) { return box.contains(p); }));
    }
    double volume = 0;
    for (const FloatBox& box : parts.boxes)
        volume += (double(box.hi[0]) - box.lo[0]) * (double(box.hi[1]) - box.lo[1]) *
                  (double(box.hi[2]) - box.lo[2]);
    EXPECT_LT(volume, 0.02 * 7 * 8 * 9);
}

TEST(part_boxes, are_one_for_a_triangle_that_fills_its_box_or_is_as_wide_as_long)
{
    const std::vector<Vec3s> points{{0, 0, 0}, {9, 0, 0}, {9, 0.01F, 0}, {5, 0, 5}, {0, 6, 6}};
    const PartBoxes parts = part_boxes(points, {{0, 1, 2}, {0, 3, 4}});
    EXPECT_EQ(parts.triangle, (std::vector<std::uint32_t>{0, 1}));
}

} // namespace
} // namespace vdb_shell
