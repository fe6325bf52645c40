// SPDX-License-Identifier: Apache-2.0
#include "pipeline/prepare_surface.h"

#include "support/faulty_shapes.h"
#include "support/shapes.h"
#include "vdb_shell/core/error.h"
#include "vdb_shell/mesh/check_mesh.h"

#include <gmock/gmock-matchers.h>
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace
{

using namespace vdb_shell;
using openvdb::Vec3d;
using openvdb::Vec3s;
using ::testing::HasSubstr;
using Tried = std::vector<Mending>;

ShellResult mended(const TriangleMesh& mesh, ShellOptions options = {})
{
    options.mend = true;
    ShellResult result;
    StageClock clock(result.report.stages, nullptr);
    prepare_surface(result, mesh, options, clock, nullptr);
    // Whatever it took: what is left is usable, by a check of its own.
    EXPECT_EQ(why_not_usable(check_mesh(result.surface), options.check), "");
    return result;
}

/// All attempts; the last of them was taken.
Tried tried(const ShellResult& result)
{
    Tried attempts;
    for (const MendAttempt& attempt : result.report.mend) {
        attempts.push_back(attempt.tried);
        EXPECT_EQ(attempt.refusal.empty(), &attempt == &result.report.mend.back());
    }
    return attempts;
}

/// A sphere with one vertex pulled under its neighbours, so that a few triangles cross.
TriangleMesh dented_sphere()
{
    TriangleMesh mesh = test::icosphere(1.0, 4);
    const openvdb::Vec3I t = mesh.triangles.front();
    mesh.points[t[0]] += 2.5F * (mesh.points[t[1]] - mesh.points[t[0]]);
    EXPECT_GT(check_mesh(mesh).self_intersections.count, 0U);
    return mesh;
}

TEST(PrepareSurface, MendingLeavesAUsableSurfaceBitForBit)
{
    const TriangleMesh mesh = test::joined(test::icosphere(1.0, 2), test::box(Vec3d(2), Vec3d(3)));
    const ShellResult result = mended(mesh);
    EXPECT_EQ(tried(result), Tried{Mending::none});
    EXPECT_EQ(result.surface.points, mesh.points);
    EXPECT_EQ(result.surface.triangles, mesh.triangles);
    EXPECT_FALSE(result.report.repair || result.report.wrap);
}

TEST(PrepareSurface, MendingClosesAHoleAndKeepsEveryTriangle)
{
    const TriangleMesh open =
        test::without(test::icosphere(1.0, 3), [](const Vec3s& p) { return p[2] > 0.9F; });
    const ShellResult result = mended(open);
    EXPECT_EQ(tried(result), (Tried{Mending::none, Mending::repair}));
    EXPECT_THAT(result.report.mend.front().refusal, HasSubstr("boundary edges"));
    ASSERT_TRUE(result.report.repair.has_value());
    EXPECT_EQ(result.report.repair->kept_triangles, open.triangles.size());
    EXPECT_FALSE(result.report.wrap.has_value());
}

TEST(PrepareSurface, CopiesOfAnAttemptThatWasNotTakenAreNotReported)
{
    ShellOptions options;
    options.check.allow_self_intersections = true;
    // Two spheres in a point, one of them open: its fans are copied, and the hole refused.
    TriangleMesh mesh = test::touching_spheres(2, 0);
    mesh.triangles.pop_back();
    const ShellResult result = mended(mesh, options);
    EXPECT_EQ(tried(result), (Tried{Mending::none, Mending::repair}));
    EXPECT_EQ(result.report.vertex_copies, 0U);
    EXPECT_EQ(result.report.split_vertices.count, 0U);
}

TEST(PrepareSurface, MendingCutsAwayWhatAWrapCouldNotShow)
{
    const TriangleMesh mesh = dented_sphere();
    const ShellResult result = mended(mesh);
    EXPECT_EQ(tried(result), (Tried{Mending::none, Mending::repair, Mending::cut_crossings}));
    ASSERT_TRUE(result.report.repair.has_value());
    EXPECT_GT(result.report.repair->kept_triangles, mesh.triangles.size() * 9 / 10);
}

TEST(PrepareSurface, MendingDropsALooseTriangleThatAWrapCouldNotShow)
{
    ShellOptions options;
    options.wrap.voxel_size = 0.0625;
    TriangleMesh mesh = test::icosphere(1.0, 4);
    const auto n = std::uint32_t(mesh.points.size());
    for (const double height : {1.01, 1.02, 1.03})
        mesh.points.emplace_back(Vec3s(Vec3d(0.02 * height, (height - 1) / 2, height)));
    mesh.triangles.emplace_back(n, n + 1, n + 2);
    const ShellResult result = mended(mesh, options);
    EXPECT_EQ(tried(result), (Tried{Mending::none, Mending::repair, Mending::drop_loose}));
    EXPECT_EQ(result.report.repair->kept_triangles, mesh.triangles.size() - 1);
    // Farther than a voxel it may be part of something.
    for (std::uint32_t i = 0; i < 3; ++i)
        mesh.points[n + i] += Vec3s(0, 0, 0.125F);
    const ShellResult far = mended(mesh, options);
    EXPECT_EQ(tried(far),
              (Tried{Mending::none, Mending::repair, Mending::drop_loose, Mending::wrap}));
    EXPECT_THAT(far.report.mend[2].refusal, HasSubstr("what is loose lies"));
}

TEST(PrepareSurface, MendingCutsNothingThatAWrapWouldShow)
{
    ShellOptions options;
    options.wrap.voxel_size = 0.0625;
    // One vertex is drawn out through the other side: a spike that cuts would take away.
    TriangleMesh mesh = test::icosphere(1.0, 4);
    mesh.points[0] *= -1.5F;
    const ShellResult result = mended(mesh, options);
    EXPECT_EQ(tried(result),
              (Tried{Mending::none, Mending::repair, Mending::cut_crossings, Mending::wrap}));
    EXPECT_THAT(result.report.mend[2].refusal, HasSubstr("more than a voxel"));
    EXPECT_FALSE(result.report.repair.has_value());
    ASSERT_TRUE(result.report.wrap.has_value());
    EXPECT_EQ(result.report.wrap->voxel_size, 0.0625);
}

TEST(PrepareSurface, MendingMakesOneSolidOfBodiesThatAreStuckIntoEachOther)
{
    ShellOptions options;
    options.wrap.voxel_size = 0.05;
    const double apart = 1.0;
    const TriangleMesh two = test::joined(test::icosphere(1.0, 4),
                                          test::translated(test::icosphere(1.0, 4), {apart, 0, 0}));
    const ShellResult result = mended(two, options);
    EXPECT_EQ(tried(result).back(), Mending::wrap);
    EXPECT_EQ(result.report.mesh.components.size(), 1U);
    // Two balls less their lens, which are two caps of height 1 - apart / 2; the wrap is within a
    // voxel of them.
    const double height = 1 - apart / 2, cap = M_PI * height * height * (3 - height) / 3;
    const double area = 8 * M_PI - 2 * 2 * M_PI * height;
    EXPECT_NEAR(result.report.mesh.volume, 8 * M_PI / 3 - 2 * cap, 0.05 * area);
}

TEST(PrepareSurface, MendingWrapsWhatHasNoInside)
{
    ShellOptions options;
    options.wrap.resolution = 24;
    for (const TriangleMesh& mesh : {test::moebius_strip(24, 3), test::klein_bottle(24, 12)})
        EXPECT_EQ(tried(mended(mesh, options)).back(), Mending::wrap);
}

TEST(PrepareSurface, MendingWrapsASheetThatARepairWouldCloseByItsBack)
{
    // A fan of six triangles in a plane, whose rim is filled in the same plane.
    TriangleMesh sheet;
    sheet.points.emplace_back(0.0F);
    for (int i = 0; i < 6; ++i) {
        sheet.points.emplace_back(std::cos(float(i)), std::sin(float(i)), 0.0F);
        sheet.triangles.emplace_back(0, 1 + i, 1 + (i + 1) % 6);
    }
    ShellOptions options;
    options.wrap.resolution = 24;
    options.check.allow_self_intersections = true;
    const ShellResult result = mended(sheet, options);
    EXPECT_EQ(tried(result).back(), Mending::wrap);
    EXPECT_GT(result.report.mesh.volume, 0.0);
}

TEST(PrepareSurface, ARepairThatWasAskedForComesFirst)
{
    ShellOptions options;
    options.repair.emplace();
    const ShellResult result = mended(test::icosphere(1.0, 2), options);
    EXPECT_EQ(tried(result), Tried{Mending::repair});
    EXPECT_TRUE(result.report.repair.has_value());
}

TEST(PrepareSurface, OfNothingNothingIsMended)
{
    EXPECT_THROW(mended(TriangleMesh{}), GeometryError);
}

TEST(PrepareSurface, WithoutMendingAFaultySurfaceIsRefused)
{
    ShellResult result;
    StageClock clock(result.report.stages, nullptr);
    EXPECT_THROW(prepare_surface(result, dented_sphere(), {}, clock, nullptr), GeometryError);
    EXPECT_TRUE(result.report.mend.empty());
}

} // namespace
