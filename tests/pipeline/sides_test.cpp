// SPDX-License-Identifier: Apache-2.0
#include "vdb_shell/pipeline.h"

#include "core/exact.h"
#include "core/grid_instances.h"
#include "support/files.h"
#include "support/shapes.h"
#include "vdb_shell/io/read_mesh.h"

#include <gtest/gtest.h>

#include <cmath>

// The whole job on each side of a surface.

namespace
{

using namespace vdb_shell;
using openvdb::Vec3d;
using test::icosphere;

ShellOptions options_for(Side side)
{
    ShellOptions options;
    options.side = side;
    options.level_set.resolution = 48;
    options.coverage.samples = 20000;
    return options;
}

void expect_sound(const ShellResult& result)
{
    EXPECT_EQ(result.report.certificate->failures(), std::vector<std::string>{});
    EXPECT_TRUE(result.report.conformity.conforming());
    EXPECT_EQ(result.report.coverage.in_several, 0U);
    EXPECT_EQ(result.report.coverage.outside_covered, 0U);
    EXPECT_EQ(result.stack.surface(result.stack.skin), result.surface.points);
    EXPECT_EQ(result.stack.triangles(), result.surface.triangles);
}

TEST(SidesBuild, BuildsEachSide)
{
    const TriangleMesh torus = test::torus(1.0, 0.3, 24, 12);
    const ShellResult inward = build_shell(torus, options_for(Side::inward));
    const ShellResult outward = build_shell(torus, options_for(Side::outward));
    const ShellResult both = build_shell(torus, options_for(Side::both));
    for (const ShellResult* result : {&inward, &outward, &both})
        expect_sound(*result);
    EXPECT_EQ(inward.stack.skin, 0U);
    EXPECT_EQ(outward.stack.skin, 1U);
    EXPECT_EQ(both.stack.skin, 1U);
    EXPECT_EQ(both.stack.layers.size(), 2U);
    // Both sides are the two single ones: the inside bit for bit where the band is as deep.
    EXPECT_EQ(both.stack.layers[1].inner, inward.stack.layers[0].inner);
    EXPECT_EQ(inward.report.outside_volume, 0);
    EXPECT_EQ(outward.report.fill, 0);
    EXPECT_EQ(outward.report.outside_volume, outward.report.shell_volume);
    EXPECT_NEAR(both.report.fill, inward.report.fill, 1e-9);
    // No thickness given: a tenth of the diagonal, which most vertices of a torus reach.
    const double cap = default_outward_thickness(torus);
    EXPECT_LE(outward.report.lines.length.max, cap);
    EXPECT_NEAR(outward.report.lines.length.median, cap, 1e-6);
}

TEST(SidesBuild, KeepsLevelSetAndThickness)
{
    const TriangleMesh cube = test::gridded_box(Vec3d(-1), Vec3d(1), 4);
    ShellOptions options = options_for(Side::both);
    options.line_step.thickness = 0.3;
    options.scale.factor = 0.5;
    options.layers.layers = 2;
    const ShellResult result = build_shell(cube, options);
    expect_sound(result);
    EXPECT_EQ(result.stack.layers.size(), 4U);
    EXPECT_EQ(result.stack.skin, 2U);
    for (std::size_t v = 0; v < cube.points.size(); ++v)
        for (const std::size_t end : {std::size_t(0), std::size_t(4)})
            EXPECT_FALSE(exact::longer_than(cube.points[v], result.stack.surface(end)[v], 0.15));
    // The field is the solid's own again: negative inside.
    EXPECT_GT(result.level_set->background(), 0.3);
    EXPECT_LT(result.level_set->getConstAccessor().getValue(
                  openvdb::Coord(openvdb::Vec3i(result.level_set->worldToIndex(Vec3d(0.9, 0, 0))))),
              0);
}

TEST(SidesBuild, RawLinesGoOutwardToo)
{
    ShellOptions options = options_for(Side::outward);
    options.grow.method = Method::raw;
    options.line_step.thickness = 0.5;
    const TriangleMesh ball = icosphere(1, 2);
    const ShellResult result = build_shell(ball, options);
    expect_sound(result); // nothing faces a ball
    const double wanted = signed_volume(ball.points, ball.triangles) * (std::pow(1.5, 3) - 1);
    EXPECT_NEAR(result.report.shell_volume, wanted, 5e-3 * wanted);
}

TEST(SidesBuild, PaintedThicknessBoundsOutwardLines)
{
    const TriangleMesh ball = icosphere(1, 2);
    auto painted = openvdb::FloatGrid::create(0.25f); // everywhere
    painted->setTransform(openvdb::math::Transform::createLinearTransform(0.1));
    ShellOptions options = options_for(Side::outward);
    const ShellResult result = build_shell(ball, options, "ball", painted.get());
    expect_sound(result);
    for (std::size_t v = 0; v < ball.points.size(); ++v) {
        EXPECT_FALSE(exact::longer_than(ball.points[v], result.stack.surface(0)[v], 0.25));
        EXPECT_NEAR(result.stack.layers[0].length(v), 0.25, 1e-3);
    }
}

TEST(SidesBuild, RealMeshesAreCertifiedOutwardAndOnBothSides)
{
    VDB_SHELL_NEEDS_REAL_MESHES();
    for (const char* name : {"cow.obj", "lamp.obj", "teapot.obj"})
        for (const Side side : {Side::outward, Side::both}) {
            SCOPED_TRACE(name);
            const ReadResult read = read_mesh(test::real_meshes() / "paper" / name, {});
            const ShellResult result = build_shell(read.mesh, options_for(side), name);
            expect_sound(result);
            EXPECT_GT(result.report.outside_volume, result.report.solid_volume);
        }
}

} // namespace
