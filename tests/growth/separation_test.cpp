// SPDX-License-Identifier: Apache-2.0
#include "growth/separation.h"

#include "core/counter_random.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <vector>

namespace
{

using openvdb::Vec3d;
using vdb_shell::growth::Corners;
using vdb_shell::growth::Slab;

constexpr double kFar = 1e300;

Slab slab(const Corners& s, const Corners& t, double enough = kFar)
{
    const vdb_shell::growth::SlabQuery query{&s, &t, enough};
    Slab found;
    vdb_shell::growth::slabs_between(&query, 1, &found);
    return found;
}

/// The slab's own promise: both triangles on their sides of it.
void expect_apart(const Corners& s, const Corners& t, const Slab& found)
{
    double size = 0;
    for (int k = 0; k < 3; ++k)
        size = std::max({size, (s[k] - s[0]).length(), (t[k] - s[0]).length()});
    for (int k = 0; k < 3; ++k) {
        EXPECT_GE(Vec3d(found.n).dot(s[k] - s[0]), found.lo - 1e-14 * size);
        EXPECT_LE(Vec3d(found.n).dot(t[k] - s[0]), found.hi + 1e-14 * size);
    }
    EXPECT_NEAR(Vec3d(found.n).length(), 1.0, 1e-6);
}

/// Closest distance by looking at many points of both: an upper bound that any slab must respect.
double sampled_distance(const Corners& s, const Corners& t)
{
    constexpr int kSteps = 24;
    double least = kFar;
    for (int i = 0; i <= kSteps; ++i)
        for (int j = 0; i + j <= kSteps; ++j)
            for (int k = 0; k <= kSteps; ++k)
                for (int l = 0; k + l <= kSteps; ++l) {
                    const auto at = [&](const Corners& c, int u, int v) {
                        return c[0] + (c[1] - c[0]) * (double(u) / kSteps) +
                               (c[2] - c[0]) * (double(v) / kSteps);
                    };
                    least = std::min(least, (at(s, i, j) - at(t, k, l)).length());
                }
    return least;
}

Corners random_triangle(const vdb_shell::CounterRandom& random, std::uint64_t id, const Vec3d& by)
{
    Corners c;
    for (std::uint64_t i = 0; i < 9; ++i)
        c[i / 3][static_cast<int>(i % 3)] = random.unit(9 * id + i) + by[static_cast<int>(i % 3)];
    return c;
}

TEST(Separation, FindsTheDistanceForEachPairOfNearestFeatures)
{
    const Corners floor{Vec3d(0, 0, 0), Vec3d(4, 0, 0), Vec3d(0, 4, 0)};
    const Corners corner_above{Vec3d(1, 1, 0.5), Vec3d(1, 2, 3), Vec3d(2, 1, 3)};
    EXPECT_NEAR(slab(floor, corner_above).gap, 0.5, 1e-6) << "face to corner";
    EXPECT_NEAR(slab(corner_above, floor).gap, 0.5, 1e-6) << "corner to face";
    const Corners beyond{Vec3d(-3, -4, 0), Vec3d(-5, -4, 1), Vec3d(-3, -6, -1)};
    EXPECT_NEAR(slab(floor, beyond).gap, 5.0, 1e-5) << "corner to corner";
    const Corners beside{Vec3d(1, -2, 1), Vec3d(0, -5, 3), Vec3d(3, -5, 3)};
    EXPECT_NEAR(slab(floor, beside).gap, std::sqrt(5.0), 1e-5) << "corner to edge";
    const Corners across{Vec3d(1, -1, 1), Vec3d(1, 3, -1), Vec3d(5, -9, 9)};
    const Slab crossed = slab({Vec3d(0, 0, 0), Vec3d(4, 0, 0), Vec3d(2, 1, -3)},
                              {Vec3d(2, -1, 0.25), Vec3d(2, 1, 0.25), Vec3d(2, 0, 4)});
    EXPECT_NEAR(crossed.gap, 0.25, 1e-6) << "edge to edge";
    EXPECT_LE(slab(floor, across).gap, 1e-6) << "pierced";
}

TEST(Separation, SmallGapsOfLongTrianglesAreFoundToo)
{
    // Nearly parallel slivers a ten-thousandth of their length apart.
    for (const double gap : {1e-2, 1e-4, 1e-6}) {
        const Corners s{Vec3d(0, 0, 0), Vec3d(10, 0, 0), Vec3d(5, -0.1, 0.03)};
        const Corners t{Vec3d(-1, gap, 0), Vec3d(12, gap, 0), Vec3d(5, 0.2, -0.05)};
        const Slab found = slab(s, t);
        expect_apart(s, t, found);
        EXPECT_GT(found.gap, 0.9 * gap);
        EXPECT_LE(found.gap, gap * (1 + 1e-3));
    }
}

TEST(Separation, IsTheWidestSlabOfRandomPairs)
{
    const vdb_shell::CounterRandom random(7);
    int apart = 0;
    for (std::uint64_t i = 0; i < 200; ++i) {
        const Vec3d by(0.9 * random.unit(100000 + 3 * i), 0.9 * random.unit(100001 + 3 * i),
                       0.9 * random.unit(100002 + 3 * i));
        const Corners s = random_triangle(random, 2 * i, Vec3d(0.0)),
                      t = random_triangle(random, 2 * i + 1, by);
        const double sampled = sampled_distance(s, t);
        const Slab found = slab(s, t);
        // Samples stand up to 0.06 apart.
        EXPECT_LE(found.gap, sampled + 1e-6) << i;
        if (found.gap <= 0)
            continue;
        ++apart;
        expect_apart(s, t, found);
        EXPECT_GE(found.gap, sampled - 0.06) << i;
    }
    EXPECT_GT(apart, 50);
}

TEST(Separation, FarFromTheOriginNothingIsLost)
{
    const Vec3d by(1048576, -2097152, 524288);
    const Corners s{by, by + Vec3d(1, 0, 0), by + Vec3d(0, 1, 0)};
    const Corners t{by + Vec3d(0, 0, 0.125), by + Vec3d(1, 0, 0.25), by + Vec3d(0, 1, 0.25)};
    EXPECT_NEAR(slab(s, t).gap, 0.125, 1e-6);
}

TEST(Separation, StopsLookingBeyondEnough)
{
    const Corners s{Vec3d(0, 0, 0), Vec3d(1, 0, 0), Vec3d(0, 1, 0)};
    const Corners t{Vec3d(0, 0, 5), Vec3d(1, 0, 5), Vec3d(0, 1, 6)};
    EXPECT_EQ(slab(s, t, 1.0).gap, std::numeric_limits<double>::infinity());
    const Slab found = slab(s, t, 5.5);
    expect_apart(s, t, found);
    EXPECT_NEAR(found.gap, 5.0, 1e-6);
}

TEST(Separation, OfAPairIsTheSameInAnyCompany)
{
    const vdb_shell::CounterRandom random(11);
    std::vector<Corners> triangles;
    for (std::uint64_t i = 0; i < 64; ++i) {
        const Vec3d by(random.unit(5000 + i), random.unit(6000 + i), random.unit(7000 + i));
        triangles.push_back(random_triangle(random, 2 * i, Vec3d(0.0)));
        triangles.push_back(random_triangle(random, 2 * i + 1, by));
    }
    std::vector<vdb_shell::growth::SlabQuery> queries;
    for (std::size_t i = 0; i < 64; ++i)
        queries.push_back({&triangles[2 * i], &triangles[2 * i + 1], i % 3 == 0 ? 0.2 : kFar});
    for (const std::size_t at_once : {2U, 5U, 8U})
        for (std::size_t first = 0; first + at_once <= queries.size(); first += at_once) {
            std::array<Slab, vdb_shell::growth::kSlabsAtOnce> found;
            vdb_shell::growth::slabs_between(&queries[first], at_once, found.data());
            for (std::size_t i = 0; i < at_once; ++i) {
                const auto& [s, t, enough] = queries[first + i];
                const Slab alone = slab(*s, *t, enough);
                EXPECT_EQ(found[i].n, alone.n);
                EXPECT_EQ(found[i].lo, alone.lo);
                EXPECT_EQ(found[i].gap, alone.gap);
            }
        }
}

TEST(Separation, IsNeverCalledWideWhereItIsNot)
{
    // Of the slab found without a limit, a little more or less than its gap.
    const vdb_shell::CounterRandom random(13);
    int apart = 0;
    for (std::uint64_t i = 0; i < 400; ++i) {
        const Vec3d by(random.unit(5000 + i), random.unit(6000 + i), 0.8 * random.unit(7000 + i));
        const Corners s = random_triangle(random, 2 * i, Vec3d(0.0)),
                      t = random_triangle(random, 2 * i + 1, by);
        const double gap = slab(s, t).gap;
        if (gap <= 0)
            continue;
        ++apart;
        EXPECT_EQ(slab(s, t, 1.0001 * gap).gap, gap);
    }
    EXPECT_GT(apart, 50);
}

TEST(Separation, TouchingAndDegenerateTrianglesHaveNoGap)
{
    const Corners s{Vec3d(0, 0, 0), Vec3d(1, 0, 0), Vec3d(0, 1, 0)};
    EXPECT_LE(slab(s, s).gap, 0.0);
    const Corners point{Vec3d(0.0), Vec3d(0.0), Vec3d(0.0)};
    EXPECT_LE(slab(point, point).gap, 0.0);
    const Corners line{Vec3d(0, 0, 1), Vec3d(1, 0, 1), Vec3d(2, 0, 1)};
    EXPECT_NEAR(slab(s, line).gap, 1.0, 1e-6);
}

} // namespace
