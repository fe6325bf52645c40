// SPDX-License-Identifier: Apache-2.0
#include "core/box_ray.h"

#include "core/counter_random.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>

namespace
{

using namespace vdb_shell;
using openvdb::Vec3d;
using openvdb::Vec3s;

FloatBox box_between(const Vec3s& p, const Vec3s& q)
{
    FloatBox box = FloatBox::around(p);
    box.add(q);
    return box;
}

/// The first of four that are the same.
unsigned meets(const Vec3d& from, const Vec3d& along, const FloatBox& box, double limit)
{
    std::array<double, 4> entry;
    return BoxRay(from, along).meets(FourBoxes::same(box), limit, entry) & 1U;
}

double entry_of(const Vec3d& from, const Vec3d& along, const FloatBox& box)
{
    std::array<double, 4> entry;
    EXPECT_NE(BoxRay(from, along).meets(FourBoxes::same(box), 1e9, entry), 0U);
    return entry[0];
}

/// Whole numbers from -8 to 8: sums and products of them are exact.
Vec3d whole_numbers(const CounterRandom& random, std::uint64_t i)
{
    const auto at = [&](std::uint64_t k) { return std::floor(17 * random.unit(3 * i + k)) - 8; };
    return {at(0), at(1), at(2)};
}

// Rays through a corner, or along a face or an edge of a box, among them those along an axis.
TEST(BoxRay, NeverMissesABoxThatItTouches)
{
    const CounterRandom random(1);
    for (std::uint64_t i = 0; i < 20000; ++i) {
        const Vec3d from = whole_numbers(random, 4 * i), way = whole_numbers(random, 4 * i + 1);
        const double limit = 2;
        const Vec3d met = from + way * (double(i % 3) * 0.5 * limit);
        // The ray runs through a corner of this box, and through whatever lies in it.
        const FloatBox box = box_between(Vec3s(met), Vec3s(whole_numbers(random, 4 * i + 2)));
        EXPECT_EQ(meets(from, way, box, limit), 1U) << from << " " << way << " " << met;
    }
}

TEST(BoxRay, SmallestAndZeroDirections)
{
    const FloatBox box = box_between({0, 0, 0}, {1, 1, 1});
    // What is between an infinite inverse and none says nothing, which is not no.
    EXPECT_EQ(meets({0.5, 0.5, 0.5}, {1e-310, 0, 1}, box, 10), 1U);
    EXPECT_EQ(meets({0, 0, -1}, {0, 0, 1}, box, 10), 1U);
    EXPECT_EQ(meets({0.5, 0.5, 0.5}, {0, 0, 0}, box, 10), 1U);
    EXPECT_EQ(meets({-0.5, 0.5, 0.5}, {0, 0, 0}, box, 10), 0U);
    EXPECT_EQ(meets({-0.5, 0.5, -1}, {0, 0, 1}, box, 10), 0U);
}

TEST(BoxRay, SaysNoBesideBehindAndBeyond)
{
    const FloatBox box = box_between({2, -1, -1}, {3, 1, 1});
    EXPECT_EQ(meets({0, 0, 0}, {1, 0, 0}, box, 10), 1U);
    EXPECT_EQ(meets({0, 0, 0}, {-1, 0, 0}, box, 10), 0U);
    EXPECT_EQ(meets({0, 0, 0}, {1, 0, 0}, box, 1.9), 0U);
    EXPECT_EQ(meets({0, 0, 0}, {1, 0.6, 0}, box, 10), 0U);
    EXPECT_EQ(meets({5, 0, 0}, {1, 0, 0}, box, 10), 0U);
}

TEST(BoxRay, ComesInWhereItDoes)
{
    const FloatBox box = box_between({2, -1, -1}, {3, 1, 1});
    EXPECT_DOUBLE_EQ(entry_of({0, 0, 0}, {1, 0, 0}, box), 2);
    EXPECT_DOUBLE_EQ(entry_of({0, 0, 0}, {4, 0.5, 0}, box), 0.5);
    EXPECT_DOUBLE_EQ(entry_of({2.5, -4, 0}, {0, 1, 0}, box), 3);
    EXPECT_DOUBLE_EQ(entry_of({2.5, 0, 0}, {0, 1, 0}, box), 0);
}

TEST(BoxRay, TellsFourBoxesApart)
{
    FourBoxes four = FourBoxes::none();
    for (std::size_t lane = 0; lane < 3; ++lane) {
        const auto at = float(lane);
        four.set(lane, box_between({at, at, -1}, {at + 0.5F, at + 0.5F, 1}));
    }
    std::array<double, 4> entry;
    // Past the second one.
    EXPECT_EQ(BoxRay({0, 0.25, 0}, {1, 0, 0}).meets(four, 10, entry) & 7U, 1U);
    EXPECT_EQ(BoxRay({1.25, -1, 0}, {0, 1, 0}).meets(four, 10, entry) & 7U, 2U);
    EXPECT_EQ(BoxRay({0, 0, 0}, {1, 1, 0}).meets(four, 10, entry) & 7U, 7U);
    EXPECT_LT(entry[0], entry[1]);
    EXPECT_LT(entry[1], entry[2]);
}

} // namespace
