// SPDX-License-Identifier: Apache-2.0
#include "shell/grow/coarse_start.h"

#include "mesh/simplify.h"
#include "support/shapes.h"
#include "support/stacks.h"
#include "vdb_shell/certify/certificate.h"
#include "vdb_shell/mesh/check_mesh.h"

#include <tbb/global_control.h>

#include <gtest/gtest.h>

namespace
{

using namespace vdb_shell;
using openvdb::Vec3d;
using openvdb::Vec3s;

double fill_of(const PrismShell& shell)
{
    return 1 - signed_volume(shell.inner, shell.triangles) /
                   signed_volume(shell.outer, shell.triangles);
}

TEST(CoarseStart, ACoarseSurfaceIsClosedAndHasPointsOfTheFineOne)
{
    const TriangleMesh fine = test::torus(2.0, 0.8, 48, 24);
    const Coarsened coarse = coarsen(fine, 300);
    EXPECT_LE(coarse.mesh.triangles.size(), 310U);
    EXPECT_GE(coarse.mesh.triangles.size(), 250U);
    const MeshCheck check = check_mesh(coarse.mesh);
    EXPECT_TRUE(check.closed() && check.manifold());
    ASSERT_EQ(coarse.from.size(), coarse.mesh.points.size());
    for (std::size_t v = 0; v < coarse.from.size(); ++v)
        EXPECT_EQ(coarse.mesh.points[v], fine.points[coarse.from[v]]);
    const double volume = signed_volume(fine.points, fine.triangles);
    EXPECT_NEAR(signed_volume(coarse.mesh.points, coarse.mesh.triangles), volume, 0.05 * volume);
}

TEST(CoarseStart, PillarsEndWhereThoseOfTheCoarseShellDo)
{
    // The coarse shell of a sphere ends at a third of its radius.
    const TriangleMesh coarse = test::icosphere(3.0, 2), fine = test::icosphere(3.0, 4);
    std::vector<Vec3d> inner;
    for (const Vec3s& p : coarse.points)
        inner.push_back(Vec3d(p) / 3.0);
    Directions lines;
    lines.inward.assign(fine.points.size(), Vec3d(0.0));
    lines.visibility.assign(fine.points.size(), 0.7);
    const growth::Pillars pillars = growth::pillars_in(coarse, inner, fine, lines);
    for (std::size_t v = 0; v < fine.points.size(); ++v) {
        const Vec3d end = Vec3d(fine.points[v]) + pillars.length[v] * pillars.lines.inward[v];
        // On a chord of the inner sphere, which lies up to 0.035 below its arc.
        EXPECT_LE(end.length(), 1.0 + 1e-6);
        EXPECT_GE(end.length(), 0.96);
        EXPECT_GT(end.unit().dot(Vec3d(fine.points[v]).unit()), 0.999);
        EXPECT_EQ(pillars.lines.visibility[v], 0.7);
    }
}

TEST(CoarseStart, APillarThatWouldLeaveOnTheOuterSideGoesAlongTheLine)
{
    const TriangleMesh sphere = test::icosphere(1.0, 2);
    std::vector<Vec3d> outside;
    for (const Vec3s& p : sphere.points)
        outside.push_back(1.5 * Vec3d(p));
    Directions lines;
    for (const Vec3s& p : sphere.points)
        lines.inward.push_back(-Vec3d(p).unit());
    lines.visibility.assign(sphere.points.size(), 1.0);
    const growth::Pillars pillars = growth::pillars_in(sphere, outside, sphere, lines);
    for (std::size_t v = 0; v < sphere.points.size(); ++v) {
        EXPECT_EQ(pillars.lines.inward[v], lines.inward[v]);
        EXPECT_NEAR(pillars.length[v], 0.5, 1e-6);
    }
}

class GrownFromCoarse : public testing::TestWithParam<Method>
{
};

// Twice over: the coarse surface is above the limit too.
TEST_P(GrownFromCoarse, IsCertifiedAndAboutAsThickAndTheSameForAnyNumberOfThreads)
{
    GrowOptions options;
    options.method = GetParam();
    for (const TriangleMesh& mesh : {test::trefoil(180, 16), test::bumpy_sphere()}) {
        options.coarse_from = 0;
        const GrowResult without = test::grown(mesh, options);
        options.coarse_from = mesh.triangles.size() / 10;
        const GrowResult with = test::grown(mesh, options);
        const PrismTest tests =
            options.method == Method::certified ? PrismTest::twelve_tets : PrismTest::chosen_tets;
        for (const std::string& failure : certify_shell(with.shell, with.split, tests).failures())
            ADD_FAILURE() << failure;
        EXPECT_NE(with.shell.inner, without.shell.inner);
        EXPECT_GT(fill_of(with.shell), fill_of(without.shell) - 0.01);
        const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, 1);
        const GrowResult alone = test::grown(mesh, options);
        EXPECT_EQ(alone.shell.inner, with.shell.inner);
        EXPECT_EQ(alone.split.order, with.split.order);
    }
}

TEST_P(GrownFromCoarse, KeepsToTheCap)
{
    GrowOptions options;
    options.method = GetParam();
    options.coarse_from = 500;
    const GrowResult result = test::grown(test::torus(2.0, 0.8, 48, 24), options, 0.125);
    for (std::size_t v = 0; v < result.shell.inner.size(); ++v)
        EXPECT_LE(result.shell.length(v), 0.125) << v;
}

INSTANTIATE_TEST_SUITE_P(Each, GrownFromCoarse,
                         testing::Values(Method::certified, Method::thickest));

} // namespace
