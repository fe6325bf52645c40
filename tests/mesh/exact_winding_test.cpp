// SPDX-License-Identifier: Apache-2.0
#include "mesh/exact_winding.h"

#include "support/shapes.h"

#include <gtest/gtest.h>

#include <cmath>

namespace
{

using namespace vdb_shell;
using openvdb::Vec3d;
using openvdb::Vec3s;

ExactWinding winding_of(const TriangleMesh& mesh, const Vec3s& point)
{
    return exact_winding(point, mesh.points, mesh.triangles);
}

TEST(ExactWinding, CountsSurfacesAroundAPointAndTheirDirection)
{
    const TriangleMesh large = test::gridded_box(Vec3d(0), Vec3d(4), 4);
    const TriangleMesh small = test::gridded_box(Vec3d(1), Vec3d(3), 2);
    // The upward ray of the middle meets corners of both, that of (0.5, 0.5) a diagonal.
    const Vec3s middle(2), between(0.5F, 0.5F, 2);
    EXPECT_EQ(winding_of(large, middle).number, 1);
    EXPECT_EQ(winding_of(test::reversed(large), middle).number, -1);
    EXPECT_EQ(winding_of(test::joined(large, small), middle).number, 2);
    EXPECT_EQ(winding_of(test::joined(large, test::reversed(small)), middle).number, 0);
    EXPECT_EQ(winding_of(test::joined(large, test::reversed(small)), between).number, 1);
    for (const Vec3s& outside : {Vec3s(2, 2, -1), Vec3s(2, 2, 5), Vec3s(-1, 2, 2), Vec3s(2, 5, 2)})
        EXPECT_EQ(winding_of(large, outside).number, 0) << outside;
}

TEST(ExactWinding, SaysThatAPointIsOnTheSurface)
{
    const TriangleMesh box = test::gridded_box(Vec3d(0), Vec3d(4), 4);
    for (const Vec3s& on : {Vec3s(0, 2, 2), Vec3s(4, 4, 4), Vec3s(0.25F, 0.5F, 0), Vec3s(2, 4, 0)})
        EXPECT_TRUE(winding_of(box, on).on_surface) << on;
    // One step of float32 off it.
    const float above = std::nextafter(4.0F, 5.0F), below = std::nextafter(4.0F, 0.0F);
    EXPECT_FALSE(winding_of(box, Vec3s(2, 2, above)).on_surface);
    EXPECT_EQ(winding_of(box, Vec3s(2, 2, above)).number, 0);
    EXPECT_EQ(winding_of(box, Vec3s(2, 2, below)).number, 1);
}

} // namespace
