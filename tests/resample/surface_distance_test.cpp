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

} // namespace
} // namespace vdb_shell::test
