// SPDX-License-Identifier: Apache-2.0
#include "vdb_shell/taper/taper.h"

#include "core/exact.h"
#include "support/broken_shells.h"
#include "support/cancelled.h"
#include "support/files.h"
#include "support/shapes.h"
#include "vdb_shell/core/error.h"
#include "vdb_shell/io/read_mesh.h"
#include "vdb_shell/pipeline.h"

#include <gmock/gmock-matchers.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <string>
#include <tuple>

// What holds for a shell that was tapered, on surfaces of every kind that the tests have.

namespace
{

using namespace vdb_shell;
using openvdb::Vec3d;
using openvdb::Vec3s;
using ::testing::HasSubstr;

ShellOptions tapered(CoreSurface core = CoreSurface::free)
{
    ShellOptions options;
    options.level_set.resolution = 48;
    options.taper.wanted = true;
    options.taper.core = core;
    return options;
}

std::size_t inner_points(const ShellStack& stack)
{
    std::set<std::tuple<float, float, float>> points;
    for (std::size_t k = 1; k < stack.surfaces(); ++k)
        for (const Vec3s& p : stack.surface(k))
            points.insert({p[0], p[1], p[2]});
    return points.size();
}

/// The certificate, and two other ways to the same verdict.
void expect_sound(const ShellResult& result)
{
    EXPECT_TRUE(result.report.certificate->certified())
        << ::testing::PrintToString(result.report.certificate->failures());
    EXPECT_TRUE(result.stack.tapered);
    EXPECT_TRUE(result.report.conformity.conforming());
    EXPECT_TRUE(find_overlaps(result.tets).none());
    EXPECT_EQ(result.report.coverage.in_several, 0U);
    EXPECT_EQ(result.report.coverage.outside_covered, 0U);
}

TEST(Taper, ABoxIsConedToOnePoint)
{
    const ShellResult result = build_shell(test::box(Vec3d(-1), Vec3d(1)), tapered());
    expect_sound(result);
    EXPECT_EQ(result.report.signs.tets, 12U); // one under each triangle
    EXPECT_EQ(inner_points(result.stack), 1U);
    EXPECT_EQ(result.report.taper->inner_points, 1U);
    EXPECT_EQ(result.report.taper->prisms_by_tets[1], 12U);
    EXPECT_NEAR(result.report.fill, 1, 1e-12); // nothing is left of the inner surface
    EXPECT_EQ(result.report.coverage.in_none, 0U);
}

TEST(Taper, FewerTetsOfBetterShape)
{
    for (const auto& [name, mesh] :
         {std::pair("sphere", test::icosphere(1, 3)),
          std::pair("torus", test::torus(2, 0.7, 32, 16)),
          std::pair("box", test::gridded_box(Vec3d(0), Vec3d(1, 2, 3), 5))}) {
        SCOPED_TRACE(name);
        ShellOptions plain = tapered();
        plain.taper.wanted = false;
        const ShellResult before = build_shell(mesh, plain), after = build_shell(mesh, tapered());
        expect_sound(after);
        EXPECT_LT(after.report.signs.tets, 2 * mesh.triangles.size());
        EXPECT_GE(after.report.signs.tets, mesh.triangles.size());
        EXPECT_GT(after.report.quality.mean_ratio.mean, before.report.quality.mean_ratio.mean);
        EXPECT_GT(after.report.fill, 0.97);
        // The report's counts are those of the tets.
        const auto& by_tets = after.report.taper->prisms_by_tets;
        EXPECT_EQ(by_tets[1] + 2 * by_tets[2] + 3 * by_tets[3], after.report.signs.tets);
        EXPECT_EQ(by_tets[0] + by_tets[1] + by_tets[2] + by_tets[3], mesh.triangles.size());
        EXPECT_EQ(after.report.taper->inner_points, inner_points(after.stack));
        // The surface is what it was.
        EXPECT_EQ(after.stack.surface(0), mesh.points);
        EXPECT_EQ(after.stack.triangles(), mesh.triangles);
    }
}

TEST(Taper, TetsThatBreakSofasRuleGetFewerWhereTheyCostMore)
{
    for (const auto& shape : {std::pair("sphere", test::icosphere(1, 3)),
                              std::pair("torus", test::torus(2, 0.7, 32, 16)),
                              std::pair("box", test::gridded_box(Vec3d(0), Vec3d(1, 2, 3), 5))}) {
        SCOPED_TRACE(shape.first);
        ShellOptions options = tapered(CoreSurface::stitched);
        options.layers.layers = 2;
        const auto broken = [&](double cost) {
            options.taper.poor_cost = cost;
            const ShellResult result = build_shell(shape.second, options);
            expect_sound(result);
            return double(result.report.quality.sofa_bad) / double(result.report.signs.tets);
        };
        const double before = broken(0);
        EXPECT_LT(broken(50), before);
    }
}

TEST(Taper, StitchingClosesTheVoid)
{
    const TriangleMesh mesh = test::torus(2, 0.7, 32, 16);
    const ShellResult free = build_shell(mesh, tapered()),
                      stitched = build_shell(mesh, tapered(CoreSurface::stitched));
    expect_sound(stitched);
    EXPECT_GE(stitched.report.fill, free.report.fill);
    EXPECT_GT(stitched.report.fill, 0.99);
}

TEST(Taper, LayersShareAndEndWhereTheyAreThin)
{
    ShellOptions options = tapered();
    options.layers.layers = 3;
    const TriangleMesh mesh = test::icosphere(1, 3);
    const ShellResult result = build_shell(mesh, options);
    expect_sound(result);
    ASSERT_EQ(result.stack.layers.size(), 3U);
    EXPECT_LT(result.report.signs.tets, 3 * 3 * mesh.triangles.size() / 2);
    for (std::size_t k = 1; k < 3; ++k)
        EXPECT_EQ(result.stack.layers[k].outer, result.stack.layers[k - 1].inner);
}

TEST(Taper, KeepsTheThicknessExactly)
{
    ShellOptions options = tapered();
    options.line_step.thickness = 0.1;
    const ShellResult result = build_shell(test::icosphere(1, 3), options);
    expect_sound(result);
    const PrismShell& shell = result.stack.layers[0];
    for (std::size_t v = 0; v < shell.outer.size(); ++v)
        EXPECT_FALSE(exact::longer_than(shell.outer[v], shell.inner[v], 0.1)) << v;
    EXPECT_LT(result.report.fill, 0.28); // 1 - .9^3, and less under flat triangles
}

TEST(Taper, TheDearerTheVoidTheFuller)
{
    ShellOptions cheap = tapered(), dear = tapered();
    cheap.taper.void_cost = 5;
    dear.taper.void_cost = 500;
    // The void of a box of few triangles is closed by merges whatever it costs; a sphere's is not.
    const TriangleMesh mesh = test::icosphere(1, 3);
    EXPECT_LT(build_shell(mesh, cheap).report.fill, build_shell(mesh, dear).report.fill);
}

TEST(Taper, MakesNoTetWorseThanItsBound)
{
    const TriangleMesh mesh = test::icosphere(1, 3);
    for (const double bound : {4.0, 12.0, 100.0}) {
        SCOPED_TRACE(bound);
        ShellOptions options = tapered();
        options.taper.worst_amips = bound;
        ShellOptions plain = options;
        plain.taper.wanted = false;
        const double before = build_shell(mesh, plain).report.quality.mean_ratio.min;
        const ShellResult result = build_shell(mesh, options);
        expect_sound(result);
        // AMIPS is 3 over the mean ratio. Tets that were worse before may be left.
        EXPECT_GE(result.report.quality.mean_ratio.min, std::min(before, 3 / bound) - 1e-9);
    }
}

TEST(Taper, ComponentsAndCavitiesStayApart)
{
    TriangleMesh mesh = test::joined(test::icosphere(2, 3), test::reversed(test::icosphere(1, 2)));
    mesh = test::joined(mesh, test::icosphere(0.7, 2));
    const ShellResult result = build_shell(mesh, tapered(CoreSurface::stitched));
    expect_sound(result);
    EXPECT_GT(result.report.fill, 0.95);
}

TEST(Taper, IsRefusedWhereThereIsNoShellInside)
{
    const TriangleMesh mesh = test::box(Vec3d(0), Vec3d(1));
    const auto expect_refused = [&](const auto& change, const char* flag) {
        ShellOptions options = tapered();
        change(options);
        try {
            build_shell(mesh, options);
            ADD_FAILURE() << flag << " was taken";
        } catch (const InvalidOption& error) {
            EXPECT_THAT(error.what(), HasSubstr(flag));
        }
    };
    expect_refused([](ShellOptions& o) { o.side = Side::outward; }, "--side");
    expect_refused([](ShellOptions& o) { o.grow.method = Method::raw; }, "--method");
    expect_refused([](ShellOptions& o) { o.scale.factor = 0.5; }, "--thickness-scale");
    expect_refused([](ShellOptions& o) { o.check.allow_self_intersections = true; },
                   "--allow-self-intersections");
    expect_refused([](ShellOptions& o) { o.taper.rounds = 0; }, "rounds");
    expect_refused([](ShellOptions& o) { o.taper.worst_amips = 2; }, "worst_amips");
}

TEST(Taper, NoTriangleOfTheSurfaceLosesItsTets)
{
    // Narrow triangles, on which every tet is bad: none would be the cheapest.
    ShellOptions options = tapered(CoreSurface::stitched);
    options.layers.layers = 2;
    options.taper.shape_power = 4;
    for (const Vec3d& size : {Vec3d(4, 1, 0.3), Vec3d(9, 1, 1), Vec3d(5, 5, 0.2)}) {
        const TriangleMesh mesh = test::box(Vec3d(0), size);
        const ShellResult result = build_shell(mesh, options);
        std::set<std::uint32_t> with_tets;
        for (std::size_t t = 0; t < result.tets.tets.size(); ++t)
            if (result.tets.prism_layer[t] == 0)
                with_tets.insert(result.tets.prism[t]);
        EXPECT_EQ(with_tets.size(), mesh.triangles.size());
    }
}

TEST(Taper, RealMeshesAreCertified)
{
    VDB_SHELL_NEEDS_REAL_MESHES();
    for (const char* name : {"cow.obj", "teapot.obj", "diku.obj", "lamp.obj", "propella.obj"})
        for (const int layers : {1, 2}) {
            SCOPED_TRACE(name);
            ShellOptions options = tapered(layers == 1 ? CoreSurface::free : CoreSurface::stitched);
            options.layers.layers = layers;
            const ReadResult read = read_mesh(test::real_meshes() / "paper" / name, {});
            const ShellResult result = build_shell(read.mesh, options, name);
            expect_sound(result);
            EXPECT_LT(result.report.signs.tets,
                      2 * read.mesh.triangles.size() * std::size_t(layers));
        }
}

TEST(Taper, CanBeCancelled)
{
    const test::SplitShell made = test::scaled_shell(test::icosphere(1, 1), 0.5f);
    ShellStack stack = one_layer(made.shell, made.split);
    const std::vector<double> cap(stack.surface(0).size(), 1.0);
    TaperOptions options;
    options.wanted = true;
    test::expect_cancelled(
        [&](Interrupter* interrupter) { taper_shell(stack, cap, options, interrupter); });
}

} // namespace
