// SPDX-License-Identifier: Apache-2.0
#include "vdb_shell/shell/quality.h"

#include <gtest/gtest.h>

#include <cmath>

namespace
{

using namespace vdb_shell;
using openvdb::Vec3d;
using openvdb::Vec3s;
using openvdb::Vec4I;

TetMesh one_tet(const Vec3s& a, const Vec3s& b, const Vec3s& c, const Vec3s& d)
{
    TetMesh mesh;
    mesh.points = {a, b, c, d};
    mesh.tets = {Vec4I(0, 1, 2, 3)};
    return mesh;
}

TEST(MeanRatio, IsOneForTheRegularTetAndSigned)
{
    const Vec3d a(1, 1, 1), b(1, -1, -1), c(-1, 1, -1), d(-1, -1, 1);
    const double ratio = mean_ratio(a, b, c, d);
    EXPECT_NEAR(std::abs(ratio), 1, 1e-15);
    EXPECT_DOUBLE_EQ(mean_ratio(a, c, b, d), -ratio);
    EXPECT_DOUBLE_EQ(mean_ratio(7.0 * a, 7.0 * b, 7.0 * c, 7.0 * d), ratio);
    EXPECT_EQ(mean_ratio(a, b, c, 0.5 * (a + b)), 0);
    EXPECT_EQ(mean_ratio(a, a, a, a), 0);
}

TEST(Quality, OfTheCornerTetIsKnown)
{
    // Volume 1/6, squared edges 3 * 1 + 3 * 2; three right angles and three of atan(sqrt 2);
    // smallest height 1/sqrt 3 over the longest edge sqrt 2.
    const QualityReport report =
        measure_quality(one_tet(Vec3s(0, 0, 0), Vec3s(1, 0, 0), Vec3s(0, 1, 0), Vec3s(0, 0, 1)));
    EXPECT_NEAR(report.mean_ratio.min, 12 * std::pow(0.5, 2.0 / 3) / 9, 1e-15);
    EXPECT_NEAR(report.min_dihedral_radians.median, std::atan(std::sqrt(2.0)), 1e-15);
    EXPECT_NEAR(report.max_dihedral_radians.median, M_PI / 2, 1e-15);
    EXPECT_NEAR(report.aspect.median, std::sqrt(1.0 / 6) / std::sqrt(2.0 / 3), 1e-15);
}

TEST(Quality, OfTheRegularTetIsPerfect)
{
    const QualityReport report = measure_quality(
        one_tet(Vec3s(1, 1, 1), Vec3s(-1, 1, -1), Vec3s(1, -1, -1), Vec3s(-1, -1, 1)));
    EXPECT_NEAR(std::abs(report.mean_ratio.mean), 1, 1e-15);
    EXPECT_NEAR(report.min_dihedral_radians.min, std::acos(1.0 / 3), 1e-15);
    EXPECT_NEAR(report.max_dihedral_radians.max, std::acos(1.0 / 3), 1e-15);
    EXPECT_NEAR(report.aspect.min, 1, 1e-15);
    EXPECT_NEAR(report.min_dihedral_radians.min * 180 / M_PI, 70.53, 5e-3);
    EXPECT_NEAR(report.edge_ratio.max, 1, 1e-15);
    EXPECT_EQ(report.slivers, 0U);
    EXPECT_EQ(report.sofa_bad, 0U);
}

TEST(Quality, AmipsIsThreeForTheRegularTetAtAnySize)
{
    const Vec3d a(1, 1, 1), b(1, -1, -1), c(-1, 1, -1), d(-1, -1, 1);
    for (const double size : {1e-6, 1.0, 1e6}) {
        const TetShape shape = shape_of({size * a, size * c, size * b, size * d});
        EXPECT_NEAR(shape.amips, 3, 1e-12);
        EXPECT_FALSE(shape.sofa_bad());
    }
    EXPECT_TRUE(std::isinf(shape_of({a, b, c, d}).amips)); // inverted
}

TEST(Quality, SliversAndWhatSofaWarnsOfAreCounted)
{
    // Four points near a square: two dihedral angles are next to 180 degrees, four next to 0.
    const QualityReport sliver = measure_quality(
        one_tet(Vec3s(0, 0, 0), Vec3s(1, 0, 0.01F), Vec3s(1, 1, 0), Vec3s(0, 1, 0.01F)));
    EXPECT_EQ(sliver.slivers, 1U);
    EXPECT_EQ(sliver.sofa_bad, 1U);
    // Well shaped but for its length: the rule has a bound for that.
    const QualityReport spike = measure_quality(
        one_tet(Vec3s(0, 0, 0), Vec3s(1, 0, 0), Vec3s(0.5F, 0.87F, 0), Vec3s(0.5F, 0.3F, 11)));
    EXPECT_EQ(spike.slivers, 0U);
    EXPECT_EQ(spike.sofa_bad, 1U);
    EXPECT_GT(spike.edge_ratio.min, 10);
}

TEST(Quality, OfFlatTetsIsFinite)
{
    const QualityReport square =
        measure_quality(one_tet(Vec3s(0, 0, 0), Vec3s(1, 0, 0), Vec3s(1, 1, 0), Vec3s(0, 1, 0)));
    EXPECT_EQ(square.mean_ratio.min, 0);
    EXPECT_EQ(square.aspect.min, 0);
    EXPECT_EQ(square.min_dihedral_radians.min, 0);
    EXPECT_DOUBLE_EQ(square.max_dihedral_radians.max, M_PI);
    const QualityReport point =
        measure_quality(one_tet(Vec3s(1, 2, 3), Vec3s(1, 2, 3), Vec3s(1, 2, 3), Vec3s(1, 2, 3)));
    EXPECT_EQ(point.aspect.min, 0);
    EXPECT_EQ(point.mean_ratio.min, 0);
}

TEST(Spread, IsByNearestRank)
{
    std::vector<double> values;
    for (int i = 100; i >= 0; --i)
        values.push_back(i);
    const Spread spread = spread_of(values);
    EXPECT_EQ(spread.min, 0);
    EXPECT_EQ(spread.p5, 5);
    EXPECT_EQ(spread.median, 50);
    EXPECT_EQ(spread.p95, 95);
    EXPECT_EQ(spread.max, 100);
    EXPECT_EQ(spread.mean, 50);
    const Spread single = spread_of({3});
    EXPECT_EQ(single.p5, 3);
    EXPECT_EQ(single.p95, 3);
    EXPECT_EQ(spread_of({}).max, 0);
}

} // namespace
