// SPDX-License-Identifier: Apache-2.0
#include "vdb_shell/shell/surface_bounds.h"

#include "support/shapes.h"

#include <gtest/gtest.h>

#include <cmath>

namespace
{

using namespace vdb_shell;
using openvdb::Vec3d;

struct Triangle {
    Vec3d a, b, c;
};
const Triangle kEquilateral{{0, 0, 0}, {1, 0, 0}, {0.5, std::sqrt(0.75), 0}};
const Triangle kNeedle{{0, 0, 0}, {10, 0, 0}, {9.9, 0.4, 0}};
const Triangle kCap{{0, 0, 0}, {10, 0, 0}, {4, 0.3, 0}};

double amips(const Triangle& t, const Vec3d& apex)
{
    return shape_of({t.a, t.b, t.c, apex}).amips;
}

TEST(SurfaceBounds, ARegularTetIsPossibleOnAnEquilateralTriangle)
{
    const Triangle& t = kEquilateral;
    EXPECT_NEAR(least_amips(t.a, t.b, t.c), 3, 1e-14);
    EXPECT_NEAR(least_amips(7.0 * t.a, 7.0 * t.b, 7.0 * t.c), 3, 1e-14);
    EXPECT_NEAR(least_edge_ratio(t.a, t.b, t.c), 1, 1e-15);
}

TEST(SurfaceBounds, NoApexIsBetterThanTheBoundAndOneReachesIt)
{
    for (const Triangle& t : {kEquilateral, kNeedle, kCap}) {
        const double bound = least_amips(t.a, t.b, t.c);
        // Over the centroid, at the root of two ninths of the squared edges.
        const double edges =
            (t.b - t.a).lengthSqr() + (t.c - t.b).lengthSqr() + (t.a - t.c).lengthSqr();
        const Vec3d best = (t.a + t.b + t.c) / 3.0 + Vec3d(0, 0, std::sqrt(2 * edges / 9));
        EXPECT_NEAR(amips(t, best), bound, 1e-9 * bound);
        for (int x = -5; x <= 15; ++x)
            for (int y = -5; y <= 5; ++y)
                for (int z = 1; z <= 20; ++z) {
                    const Vec3d apex(x, 0.5 * y, 0.5 * z);
                    EXPECT_GE(amips(t, apex), bound * (1 - 1e-12));
                    EXPECT_GE(shape_of({t.a, t.b, t.c, apex}).edge_ratio,
                              least_edge_ratio(t.a, t.b, t.c) * (1 - 1e-12));
                }
    }
}

TEST(SurfaceBounds, ATriangleWithoutAreaHasNone)
{
    EXPECT_TRUE(std::isinf(least_amips(Vec3d(0), Vec3d(1, 0, 0), Vec3d(2, 0, 0))));
    EXPECT_TRUE(std::isinf(least_edge_ratio(Vec3d(0), Vec3d(0), Vec3d(2, 0, 0))));
}

TEST(SurfaceBounds, EveryTriangleHasATetOfSixtyDegrees)
{
    // Turned by 60 degrees about the longest edge (docs/theory.md, "What the surface bounds").
    for (const Triangle& t : {kEquilateral, kNeedle, kCap}) {
        const Vec3d apex(t.c[0], 0.5 * t.c[1], std::sqrt(0.75) * t.c[1]);
        EXPECT_GE(shape_of({t.a, t.b, t.c, apex}).min_dihedral_radians, M_PI / 3 - 1e-9);
    }
}

TEST(SurfaceBounds, EdgesOfABoxHaveRightAnglesAndDiagonalsNone)
{
    const TriangleMesh box = test::box(Vec3d(-1), Vec3d(1));
    std::size_t right = 0, flat = 0;
    for (const auto& [edge, angle] : edge_angles(box, Side::inward)) {
        right += std::abs(angle - M_PI / 2) < 1e-12;
        flat += std::abs(angle - M_PI) < 1e-12;
    }
    EXPECT_EQ(right, 12U);
    EXPECT_EQ(flat, 6U);
    EXPECT_NEAR(edge_angles(box, Side::outward)[0].radians +
                    edge_angles(box, Side::inward)[0].radians,
                2 * M_PI, 1e-12);

    const SurfaceBounds inward = measure_surface_bounds(box, Side::inward);
    EXPECT_NEAR(inward.min_dihedral_radians.min, M_PI / 4, 1e-12); // two tets share a right angle
    EXPECT_NEAR(inward.min_dihedral_radians.max, std::acos(1.0 / 3), 1e-12);
    EXPECT_NEAR(inward.edge_ratio.max, std::sqrt(2.0), 1e-12);
    EXPECT_EQ(inward.sofa_bad, 0U);
    // Half a square: squared edges 4 + 4 + 8, area 2.
    EXPECT_NEAR(inward.amips.max, 3 * std::cbrt(4.0 / 3), 1e-12);
    EXPECT_NEAR(measure_surface_bounds(box, Side::outward).min_dihedral_radians.min,
                std::acos(1.0 / 3), 1e-12);
}

TEST(SurfaceBounds, LongTrianglesAreCounted)
{
    // Eight of the twelve triangles are 21 long and 1 wide, so every tet on them is.
    const TriangleMesh rod = test::box(Vec3d(0), Vec3d(21, 1, 1));
    EXPECT_EQ(measure_surface_bounds(rod, Side::inward).sofa_bad, 8U);
}

} // namespace
