// SPDX-License-Identifier: Apache-2.0
#include "vdb_shell/volume/shell_sampler.h"

#include "core/parallel.h"
#include "support/shapes.h"
#include "write/hand_made.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace vdb_shell
{
namespace
{

using openvdb::Vec3d;

constexpr double kInnerScale = 0.5;

ShellMap ball(double stretch = 1)
{
    test::HandMade made = test::hand_made_shell(test::icosphere(1.0, 2), kInnerScale, {3});
    for (auto* points : {&made.shell.outer, &made.shell.inner, &made.tets.points})
        for (openvdb::Vec3s& p : *points)
            p[0] = float(p[0] * stretch);
    return {one_layer(made.shell, made.split), made.tets};
}

/// Points spread over the box around the ball, and beyond.
Vec3d spread(std::size_t i)
{
    const auto part = [&](double step) {
        const double x = 0.5 + double(i) * step;
        return 2.4 * (x - std::floor(x)) - 1.2;
    };
    return {part(0.8191725134), part(0.6710436067), part(0.5497004779)};
}

TEST(ShellSampler, FindsWhatLiesInTheShellAndNothingElse)
{
    const ShellMap map = ball();
    const ShellSampler sampler(map);
    std::size_t found = 0;
    for (std::size_t i = 0; i < 20000; ++i) {
        const Vec3d point = spread(i);
        const ShellPlace place = sampler.find(point);
        if (place.found()) {
            ++found;
            EXPECT_LT((map.point_of(place) - point).length(), 1e-10);
        }
        // The sphere's facets lie up to four hundredths below it, half as much on the inner one;
        // around the pinned vertex the shell ends earlier.
        const double r = point.length();
        if (r > 1 || r < kInnerScale * 0.95) {
            EXPECT_FALSE(place.found()) << point;
        } else if (r < 0.95 && r > kInnerScale &&
                   (point / r - Vec3d(map.tets().points[3])).length() > 0.7) {
            EXPECT_TRUE(place.found()) << point;
        }
    }
    EXPECT_GT(found, 4000u);
}

TEST(ShellSampler, IsTheSameWhateverTheGrid)
{
    const ShellMap map = ball();
    const ShellSampler coarse(map, 0.3), fine(map, 0.01);
    for (std::size_t i = 0; i < 5000; ++i) {
        const ShellPlace a = coarse.find(spread(i)), b = fine.find(spread(i));
        ASSERT_EQ(a.found(), b.found());
        if (a.found()) {
            EXPECT_NEAR(map.on_surface(a).share, map.on_surface(b).share, 1e-8);
        }
    }
}

TEST(ShellSampler, CarriesPointsToAnotherPose)
{
    const ShellMap map = ball(), posed = ball(2);
    const ShellSampler sampler(map);
    // The stretch is linear, and so is a prism's map of it.
    for (std::size_t i = 0; i < 5000; ++i) {
        const ShellPlace place = sampler.find(spread(i));
        if (place.found()) {
            EXPECT_LT((posed.point_of(place) - spread(i) * Vec3d(2, 1, 1)).length(), 1e-6);
        }
    }
}

TEST(ShellSampler, ServesManyThreads)
{
    const ShellMap map = ball();
    const ShellSampler sampler(map);
    std::vector<ShellPlace> places(20000);
    for_each_index(places.size(), [&](std::size_t i) { places[i] = sampler.find(spread(i)); });
    for (std::size_t i = 0; i < places.size(); ++i) {
        const ShellPlace one = sampler.find(spread(i));
        EXPECT_EQ(one.tet, places[i].tet);
        EXPECT_EQ(one.weight, places[i].weight);
    }
}

TEST(ShellSampler, PointsWithoutAPlace)
{
    const ShellMap map = ball();
    const ShellSampler sampler(map);
    EXPECT_FALSE(sampler.find(Vec3d(1e30)).found());
    EXPECT_FALSE(sampler.find(Vec3d(std::numeric_limits<double>::quiet_NaN())).found());
    EXPECT_FALSE(sampler.find(Vec3d(0.0)).found());
}

} // namespace
} // namespace vdb_shell
