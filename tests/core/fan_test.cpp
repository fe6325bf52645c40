// SPDX-License-Identifier: Apache-2.0
#include "core/fan.h"

#include "core/counter_random.h"
#include "core/exact.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace
{

using openvdb::Vec3d;
using openvdb::Vec3s;
using vdb_shell::CounterRandom;
using vdb_shell::Fan;

Fan fan_of(const std::vector<Vec3s>& points)
{
    return Fan(Vec3d(points[0]), points.size() - 1,
               [&](std::size_t i) { return Vec3d(points[1 + i]); });
}

openvdb::Vec3I triangle(std::size_t i, std::size_t rim)
{
    return {0, std::uint32_t(1 + i), std::uint32_t(1 + (i + 1) % rim)};
}

bool flat(const std::vector<Vec3s>& points, const openvdb::Vec3I& t)
{
    return vdb_shell::exact::collinear(points[t[0]], points[t[1]], points[t[2]]);
}

/// An apex at the origin and rim points at these angles and heights, once or more often round.
std::vector<Vec3s> wheel(std::size_t rim, double turns, double height, double wave = 0)
{
    std::vector<Vec3s> points{Vec3s(0.0F)};
    for (std::size_t i = 0; i < rim; ++i) {
        const double angle = 2 * M_PI * turns * double(i) / double(rim);
        points.emplace_back(float(std::cos(angle)), float(std::sin(angle)),
                            float(height + wave * (i % 2 == 0 ? 1 : -1)));
    }
    return points;
}

TEST(Fan, IsEmbeddedWhereItsTrianglesLieSideBySideOnce)
{
    for (std::size_t rim = 3; rim <= Fan::kMost; ++rim) {
        EXPECT_TRUE(fan_of(wheel(rim, 1, 0)).surely_embedded()) << rim;
        EXPECT_TRUE(fan_of(wheel(rim, -1, 0.7)).surely_embedded()) << rim;
        EXPECT_TRUE(fan_of(wheel(rim, 1, -3)).surely_embedded()) << rim;
    }
    EXPECT_TRUE(fan_of(wheel(8, 1, 0, 0.3)).surely_embedded());
}

TEST(Fan, IsNotEmbeddedWhereItTurnsTwiceOrFoldsBack)
{
    EXPECT_FALSE(fan_of(wheel(9, 2, 0)).surely_embedded());
    EXPECT_FALSE(fan_of(wheel(20, 3, 0.5)).surely_embedded());
    std::vector<Vec3s> folded = wheel(6, 1, 0);
    std::swap(folded[2], folded[3]);
    EXPECT_FALSE(fan_of(folded).surely_embedded());
    std::vector<Vec3s> doubled = wheel(6, 1, 0);
    doubled[3] = doubled[2];
    EXPECT_FALSE(fan_of(doubled).surely_embedded()) << "a triangle without area";
}

TEST(Fan, TellsMostPairsApartThatHaveTheApexAloneInCommon)
{
    constexpr std::size_t kRim = 7;
    const Fan fan = fan_of(wheel(kRim, 1, -0.05, 0.005));
    for (std::size_t i = 0; i < kRim; ++i)
        for (std::size_t skip = 2; skip + 1 < kRim; ++skip)
            EXPECT_TRUE(fan.surely_apart_from(i) >> (i + skip) % kRim & 1U) << i << " " << skip;
    for (std::size_t i = 0; i < kRim; ++i)
        for (const std::size_t beside : {std::size_t(0), std::size_t(1), kRim - 1})
            EXPECT_FALSE(fan.surely_apart_from(i) >> (i + beside) % kRim & 1U) << "a common edge";
}

// On a lattice so coarse that many triangles lie in one plane or have corners on each other.
TEST(Fan, SaysNothingOfTrianglesThatMeetElsewhere)
{
    int embedded = 0, apart = 0, meeting = 0;
    for (const std::uint32_t steps : {3U, 6U, 1000U}) {
        const CounterRandom random(steps);
        for (std::uint64_t trial = 0; trial < 6000; ++trial) {
            const std::size_t rim = 3 + trial % 6;
            // Rim points about where those of a wheel are: else hardly any is embedded.
            std::vector<Vec3s> points = wheel(rim, 1, 0.2);
            for (std::size_t i = 0; i < points.size(); ++i)
                for (int k = 0; k < 3; ++k)
                    points[i][k] =
                        float(std::round(points[i][k] * float(steps) / 2) / float(steps) +
                              (double(random.below(32 * trial + 3 * i + std::uint64_t(k), steps)) /
                                   steps -
                               0.5));
            bool any_flat = false, any_meets = false;
            for (std::size_t i = 0; i < rim; ++i)
                any_flat = any_flat || flat(points, triangle(i, rim));
            const Fan fan = fan_of(points);
            if (any_flat) {
                EXPECT_FALSE(fan.surely_embedded());
                continue;
            }
            for (std::size_t i = 0; i < rim; ++i) {
                const std::uint32_t apart_from_i = fan.surely_apart_from(i);
                for (std::size_t j = 0; j < rim; ++j) {
                    if (i == j)
                        continue;
                    const bool meet = vdb_shell::exact::triangles_touch(points, triangle(i, rim),
                                                                        triangle(j, rim));
                    any_meets = any_meets || meet;
                    meeting += meet;
                    if ((apart_from_i >> j & 1U) == 0)
                        continue;
                    ++apart;
                    ASSERT_FALSE(meet) << steps << " " << trial << " " << i << " " << j;
                }
            }
            const bool said = fan.surely_embedded();
            embedded += said;
            ASSERT_FALSE(said && any_meets) << steps << " " << trial;
        }
    }
    EXPECT_GT(embedded, 1000);
    EXPECT_GT(apart, 5000);
    EXPECT_GT(meeting, 1000);
}

TEST(Fan, IsSeenFarFromTheOriginToo)
{
    for (const float away : {0.0F, 1000.0F, 100000.0F}) {
        std::vector<Vec3s> points = wheel(6, 1, 0.25);
        for (Vec3s& p : points)
            p += Vec3s(away, -away, away);
        EXPECT_TRUE(fan_of(points).surely_embedded()) << away;
    }
}

} // namespace
