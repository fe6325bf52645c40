// SPDX-License-Identifier: Apache-2.0
// Lines outward: those of the reversed surface in the negated level set.
#include "vdb_shell/step/line_step.h"

#include "core/grid_instances.h"
#include "support/shapes.h"
#include "vdb_shell/field/level_set.h"
#include "vdb_shell/mesh/normals.h"
#include "vdb_shell/shell/sides.h"

#include <gtest/gtest.h>

#include <cmath>

namespace
{

using namespace vdb_shell;
using openvdb::Vec3d;
using openvdb::Vec3s;
using test::icosphere;

LineLengths lines_outward(const TriangleMesh& mesh, double thickness, StopTest test)
{
    LevelSetOptions band;
    band.resolution = 64;
    band.exterior_depth = thickness;
    const auto level_set = mesh_to_level_set(mesh, band);
    negate_level_set(*level_set);
    const TriangleMesh reversed = reversed_surface(mesh);
    LineStepOptions options;
    options.test = test;
    options.thickness = thickness;
    return line_step(reversed, *level_set, directions_along(reversed, pseudo_normals(reversed)),
                     options);
}

TEST(OutwardLines, GoOutwardUnderEveryStopTest)
{
    const TriangleMesh ball = icosphere(1, 2);
    for (const StopTest test :
         {StopTest::none, StopTest::normal, StopTest::start_gradient, StopTest::distance,
          StopTest::bisection, StopTest::relative_normal}) {
        // Nothing around a ball ends a line but the thickness.
        const LineLengths lengths = lines_outward(ball, 0.5, test);
        for (std::size_t v = 0; v < ball.points.size(); ++v) {
            EXPECT_EQ(lengths.length[v], 0.5) << v;
            EXPECT_EQ(lengths.reason[v], StopReason::thickness) << v;
        }
    }
}

// Between two facing squares of side 2 the sheet lies half-way.
TEST(OutwardLines, StopAtTheOutsidesMedialAxis)
{
    const TriangleMesh slab = test::gridded_box(Vec3d(0, -1, -1), Vec3d(0.5, 1, 1), 4);
    const TriangleMesh two = test::joined(slab, test::translated(slab, Vec3d(0.5 + 0.4, 0, 0)));
    const LineLengths lengths = lines_outward(two, 0.4, StopTest::normal);
    const double voxel = 2.0 / 64;
    std::size_t facing = 0;
    for (std::size_t v = 0; v < two.points.size(); ++v) {
        const Vec3s& p = two.points[v];
        if ((p[0] != 0.5f && p[0] != 0.9f) || std::abs(p[1]) == 1 || std::abs(p[2]) == 1)
            continue;
        ++facing;
        EXPECT_EQ(lengths.reason[v], StopReason::stop_test) << v;
        EXPECT_NEAR(lengths.length[v], 0.2, 2 * voxel) << v;
    }
    EXPECT_EQ(facing, 18U);
}

} // namespace
