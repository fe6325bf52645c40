// SPDX-License-Identifier: Apache-2.0
#include "growth/untangle.h"

#include "growth/half_full_sphere.h"
#include "growth/mend_prolonged.h"
#include "growth/move_tests.h"

#include <tbb/global_control.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace
{

using namespace vdb_shell;
using namespace vdb_shell::growth;
using test::kInfinity;

int invalid_prisms(const GrowState& s)
{
    int count = 0;
    for (int f = 0; f < s.mesh->face_count(); ++f)
        count += !prism_valid(s, f);
    return count;
}

/// Marks of the vertices of a sphere whose inner points are thrown about.
struct NoisySphere : test::HalfFullSphere {
    explicit NoisySphere(double noise, double cap = kInfinity) : HalfFullSphere(noise, 7, cap) {}
    std::vector<std::uint8_t> all() const { return std::vector<std::uint8_t>(s.b.size(), 1); }
    std::vector<std::uint8_t> none() const { return std::vector<std::uint8_t>(s.b.size(), 0); }
};

TEST(Untangle, MakesTheTwelveTetsOfEveryPrismPositive)
{
    NoisySphere sphere(0.06);
    ASSERT_GT(invalid_prisms(sphere.s), 200);
    std::vector<std::uint8_t> look = sphere.all(), moved = sphere.none();
    untangle(sphere.s, 60, look, moved, UntangledTets::twelve);
    EXPECT_EQ(invalid_prisms(sphere.s), 0);
    EXPECT_EQ(std::count(look.begin(), look.end(), 1), 0);
    // Nobody went further than the noise had sent them, give or take.
    for (const Vec3d& p : sphere.s.b) {
        EXPECT_GT(p.length(), 0.35);
        EXPECT_LT(p.length(), 0.65);
    }
}

TEST(Untangle, MakesTheChosenTetsPositiveByShorterMovesThanAllTwelve)
{
    const auto way = [](UntangledTets tets) {
        NoisySphere sphere(0.06);
        sphere.s.twelve = tets == UntangledTets::twelve;
        const std::vector<Vec3d> before = sphere.s.b;
        EXPECT_GT(invalid_prisms(sphere.s), 100);
        std::vector<std::uint8_t> look = sphere.all(), moved = sphere.none();
        untangle(sphere.s, 60, look, moved, tets);
        EXPECT_EQ(invalid_prisms(sphere.s), 0);
        double sum = 0;
        for (std::size_t v = 0; v < before.size(); ++v)
            sum += (sphere.s.b[v] - before[v]).length();
        return sum;
    };
    EXPECT_LT(way(UntangledTets::chosen), 0.8 * way(UntangledTets::twelve));
}

TEST(Untangle, MovesAlongTheInnerSurfaceBeforeItMovesAcross)
{
    // Thrown about on their sphere, so that what is wrong can be put right there.
    NoisySphere sphere(0.08);
    for (Vec3d& p : sphere.s.b)
        p = rounded(0.5 * p.unit());
    const std::vector<Vec3d> before = sphere.s.b;
    ASSERT_GT(invalid_prisms(sphere.s), 200);
    std::vector<std::uint8_t> look = sphere.all(), moved = sphere.none();
    untangle(sphere.s, 60, look, moved, UntangledTets::twelve);
    EXPECT_EQ(invalid_prisms(sphere.s), 0);
    double along = 0, across = 0;
    for (std::size_t v = 0; v < before.size(); ++v) {
        const double height = sphere.s.b[v].dot(before[v].unit());
        across += std::abs(sphere.s.b[v].length() - 0.5);
        along += (sphere.s.b[v] - height * before[v].unit()).length();
    }
    EXPECT_LT(across, 0.1 * along);
}

TEST(Untangle, LeavesAloneWhatIsValid)
{
    NoisySphere sphere(0.0);
    ASSERT_EQ(invalid_prisms(sphere.s), 0);
    const std::vector<Vec3d> before = sphere.s.b;
    std::vector<std::uint8_t> look = sphere.all(), moved = sphere.none();
    untangle(sphere.s, 5, look, moved, UntangledTets::twelve);
    EXPECT_EQ(sphere.s.b, before);
    EXPECT_EQ(moved, sphere.none());
}

TEST(Untangle, LooksOnlyWhereItIsTold)
{
    NoisySphere sphere(0.06);
    const std::vector<Vec3d> before = sphere.s.b;
    std::vector<std::uint8_t> look = sphere.none(), moved = sphere.none();
    untangle(sphere.s, 5, look, moved, UntangledTets::twelve);
    EXPECT_EQ(sphere.s.b, before);
    look[100] = 1;
    untangle(sphere.s, 1, look, moved, UntangledTets::twelve);
    for (std::size_t v = 0; v < before.size(); ++v)
        EXPECT_EQ(sphere.s.b[v] != before[v], moved[v] != 0) << v;
}

TEST(Untangle, KeepsPinsAndTheCap)
{
    NoisySphere sphere(0.06, 0.52);
    for (std::size_t v = 0; v < sphere.s.b.size(); ++v)
        if (!within_cap(sphere.s, static_cast<int>(v), sphere.s.b[v]))
            sphere.s.b[v] = rounded(0.52 * sphere.s.a[v]);
    for (const int pin : {3, 40, 41}) {
        sphere.s.pinned[pin] = 1;
        sphere.s.b[pin] = sphere.s.a[pin];
    }
    std::vector<std::uint8_t> look = sphere.all(), moved = sphere.none();
    untangle(sphere.s, 20, look, moved, UntangledTets::twelve);
    for (int v = 0; v < sphere.s.mesh->vertices; ++v)
        EXPECT_TRUE(within_cap(sphere.s, v, sphere.s.b[v])) << v;
    for (const int pin : {3, 40, 41})
        EXPECT_EQ(sphere.s.b[pin], sphere.s.a[pin]);
}

TEST(Untangle, IsTheSameForAnyNumberOfThreads)
{
    NoisySphere many(0.1), one(0.1);
    std::vector<std::uint8_t> look = many.all(), moved = many.none();
    untangle(many.s, 10, look, moved, UntangledTets::twelve);
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, 1);
    std::vector<std::uint8_t> look_one = one.all(), moved_one = one.none();
    untangle(one.s, 10, look_one, moved_one, UntangledTets::twelve);
    EXPECT_EQ(many.s.b, one.s.b);
    EXPECT_EQ(moved, moved_one);
}

Directions radial(const NoisySphere& sphere)
{
    Directions directions;
    for (const Vec3d& p : sphere.s.a)
        directions.inward.push_back(-p);
    directions.visibility.assign(sphere.s.a.size(), 1.0);
    return directions;
}

int all_contacts(const GrowState& s)
{
    int count = 0;
    for (int f = 0; f < s.mesh->face_count(); ++f) {
        const InnerTriangle triangle(s, f);
        for (int g = 0; g < s.mesh->face_count(); ++g)
            count += (g > f && triangle.meets_inner(g)) || triangle.meets_outer(g);
    }
    return count;
}

TEST(MendProlonged, EndsValidAndLosesLittleWhereLittleIsWrong)
{
    NoisySphere sphere(0.0);
    // All but one end at a tenth of the radius; that one goes through the middle and beyond.
    std::vector<double> lengths(sphere.s.a.size(), 0.9);
    lengths[100] = 1.15;
    mend_prolonged(sphere.s, radial(sphere), lengths, StageProgress(nullptr, "test"));
    EXPECT_EQ(invalid_prisms(sphere.s), 0);
    EXPECT_EQ(all_contacts(sphere.s), 0);
    EXPECT_EQ(count_pins(sphere.s), 0);
    int short_ones = 0;
    for (std::size_t v = 0; v < lengths.size(); ++v)
        short_ones += (sphere.s.b[v] - sphere.s.a[v]).length() < 0.85;
    EXPECT_LT(short_ones, 12);
}

TEST(MendProlonged, EndsEvenWhereEverythingIsWrong)
{
    NoisySphere sphere(0.0);
    mend_prolonged(sphere.s, radial(sphere), std::vector<double>(sphere.s.a.size(), 1.5),
                   StageProgress(nullptr, "test"));
    EXPECT_EQ(invalid_prisms(sphere.s), 0);
    EXPECT_EQ(all_contacts(sphere.s), 0);
}

} // namespace
