// SPDX-License-Identifier: Apache-2.0
#include "vdb_shell/resample/surface_distance.h"

#include "vdb_shell/core/error.h"

#include "support/shapes.h"

#include <gtest/gtest.h>

#include <cmath>

namespace vdb_shell::test
{
namespace
{

TEST(SurfaceDistance, IsOneSided)
{
    const TriangleMesh small = gridded_box({0, 0, 0}, {1, 1, 1}, 2);
    const TriangleMesh both = joined(small, translated(small, {5, 0, 0}));
    EXPECT_NEAR(surface_distance(small, both, 0.1).max, 0.0, 1e-12);
    // The far face of the second box, at x = 6, is 5 away from the first.
    EXPECT_DOUBLE_EQ(surface_distance(both, small, 0.1).max, 5.0);
}

TEST(SurfaceDistance, OfParallelSheetsIsTheirGap)
{
    const TriangleMesh low{{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, {{0, 1, 2}, {0, 2, 3}}};
    const DistanceFigures figures = surface_distance(low, translated(low, {0, 0, 0.25}), 0.05);
    EXPECT_DOUBLE_EQ(figures.mean, 0.25);
    EXPECT_DOUBLE_EQ(figures.max, 0.25);
    EXPECT_GT(figures.samples, 400U);
}

TEST(SurfaceDistance, OfManySheetsInOnePlaceAsksForOne)
{
    // A fan of steep triangles about one edge, and the same some hundred times over.
    TriangleMesh fan;
    for (int i = 0; i < 5; ++i) {
        const auto first = std::uint32_t(fan.points.size());
        fan.points.insert(fan.points.end(),
                          {{0, 0, 0}, {0, 0, 1}, {1, 0.2F * float(i), 0.1F * float(i)}});
        fan.triangles.emplace_back(first, first + 1, first + 2);
    }
    TriangleMesh many;
    for (int i = 0; i < 200; ++i)
        many = joined(many, fan);
    const TriangleMesh floor{{{-9, -9, -2}, {9, -9, -2}, {9, 9, -2}, {-9, 9, -2}},
                             {{0, 1, 2}, {0, 2, 3}}};
    constexpr double kSpacing = 0.1;
    const DistanceFigures plain = surface_distance(fan, floor, kSpacing),
                          figures = surface_distance(many, floor, kSpacing);
    EXPECT_LT(figures.samples, plain.samples);
    EXPECT_NEAR(figures.mean, plain.mean, 0.5 * kSpacing);
    // One point stands for all in a cube of the spacing.
    EXPECT_LE(figures.max, plain.max);
    EXPECT_GT(figures.max, plain.max - std::sqrt(3.0) * kSpacing);
}

TEST(SurfaceDistance, OfThinPlatesAsksOnBothSides)
{
    // Two sheets in each cube of the spacing: the wall is as far from one as from the other.
    const TriangleMesh plate = gridded_box({0, 0, 0}, {1, 1, 0.01F}, 2);
    const TriangleMesh below = gridded_box({0, 0, -1}, {1, 1, -0.99F}, 2);
    const DistanceFigures figures = surface_distance(plate, below, 0.1);
    EXPECT_NEAR(figures.max, 1.0, 1e-6);
    EXPECT_NEAR(figures.mean, 0.995, 1e-3);
}

TEST(SurfaceDistance, SeesWhatLiesBetweenTheCorners)
{
    // All corners of the square lie on the cross's ends; its middle does not.
    const TriangleMesh flat{{{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}},
                            {{0, 1, 2}, {0, 2, 3}}};
    const TriangleMesh tent{{{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}, {0, 0, 1}},
                            {{0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}}};
    // From the middle of the square to the tent's faces: 1 / sqrt(2).
    EXPECT_NEAR(surface_distance(flat, tent, 0.05).max, std::sqrt(0.5), 0.03);
    EXPECT_DOUBLE_EQ(surface_distance(tent, flat, 0.05).max, 1.0);
}

TEST(SurfaceDistance, IsAccurateFarFromTheOrigin)
{
    const TriangleMesh here = icosphere(1.0, 3);
    TriangleMesh there = here;
    for (openvdb::Vec3s& p : there.points)
        p += openvdb::Vec3s(65536, 0, 0);
    TriangleMesh shifted = there;
    for (openvdb::Vec3s& p : shifted.points)
        p += openvdb::Vec3s(4, 0, 0);
    EXPECT_NEAR(surface_distance(shifted, there, 0.2).max, 4.0, 0.01);
}

TEST(SurfaceDistance, RefusesEmptySurfacesAndBadSpacings)
{
    const TriangleMesh mesh = unit_tetrahedron();
    EXPECT_THROW(surface_distance(mesh, {}, 0.1), GeometryError);
    EXPECT_THROW(surface_distance({}, mesh, 0.1), GeometryError);
    for (const double spacing : {0.0, -1.0, std::nan(""), 1e-6})
        EXPECT_THROW(surface_distance(mesh, mesh, spacing), InvalidOption) << spacing;
}

TEST(SurfaceDistance, CountsTrianglesWithoutWidthByTheirLength)
{
    // No area, and as many pieces as it is long.
    TriangleMesh needle;
    needle.points = {{0, 0, 0}, {1e6F, 0, 0}, {2e6F, 0, 0}};
    needle.triangles = {{0, 1, 2}};
    EXPECT_THROW(surface_distance(needle, unit_tetrahedron(), 1e-3), InvalidOption);
    EXPECT_NO_THROW(surface_distance(needle, unit_tetrahedron(), 1e3));
}

TEST(SurfaceDistance, TakesNoFinerSpacingThanGivesPointsThatFit)
{
    TriangleMesh copies;
    copies.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    copies.triangles.assign(20000, {0, 1, 2});
    const double finest = finest_spacing(copies);
    // Eight pieces for each square of it, 2^27 in all; edges are few beside them.
    EXPECT_NEAR(finest, std::sqrt(8 * 0.5 * 20000 / std::pow(2, 27)), 0.05 * finest);
    EXPECT_THROW(surface_distance(copies, copies, 0.99 * finest), InvalidOption);
}

} // namespace
} // namespace vdb_shell::test
