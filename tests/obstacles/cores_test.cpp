// SPDX-License-Identifier: Apache-2.0
#include "vdb_shell/obstacles/cores.h"

#include "support/cancelled.h"
#include "support/cores.h"
#include "support/shapes.h"
#include "vdb_shell/certify/stack_certificate.h"
#include "vdb_shell/core/error.h"
#include "vdb_shell/mesh/check_mesh.h"
#include "vdb_shell/pipeline.h"

#include <gmock/gmock-matchers.h>
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>
#include <cstring>
#include <functional>
#include <string>
#include <vector>

// Shells that end on or before surfaces inside, and surfaces that cannot be that.

namespace
{

using namespace vdb_shell;
using openvdb::Vec3d;
using openvdb::Vec3s;
using test::ball;
using ::testing::AllOf;
using ::testing::HasSubstr;

constexpr double kPi = 3.14159265358979323846;

ShellOptions coarse_field()
{
    ShellOptions options;
    options.level_set.resolution = 64;
    return options;
}

ShellResult build(const TriangleMesh& mesh, const std::vector<CoreMesh>& cores,
                  const ShellOptions& options = coarse_field())
{
    return build_shell(mesh, options, "skin", nullptr, nullptr, cores);
}

/// Certified with the cores, and again without them, as `check` does; and by brute force no tet
/// meets a core.
void expect_clear(const ShellResult& result)
{
    EXPECT_TRUE(result.report.certificate->certified())
        << ::testing::PrintToString(result.report.certificate->failures());
    EXPECT_TRUE(certify_stack(result.stack, PrismTest::twelve_tets).certified());
    for (const CoreMesh& core : result.cores->given)
        EXPECT_EQ(test::tets_that_meet(result.tets, core.mesh), 0U) << core.name;
    EXPECT_EQ(test::tets_that_meet(result.tets, result.cores->kept_out), 0U);
    EXPECT_EQ(result.report.coverage.outside_covered, 0U);
    EXPECT_EQ(result.report.coverage.in_several, 0U);
    EXPECT_EQ(result.surface.points.size(), result.stack.surface(0).size());
    EXPECT_EQ(result.core_feet.size(), result.surface.points.size());
    EXPECT_EQ(result.directions.inward.size(), result.surface.points.size());
    EXPECT_EQ(result.lengths.length.size(), result.surface.points.size());
    EXPECT_EQ(result.core_vertices.count, 0U);
}

double volume(const TriangleMesh& mesh)
{
    return signed_volume(mesh.points, mesh.triangles);
}

/// Of the message that it is refused with.
std::string refusal(const TriangleMesh& mesh, const std::vector<CoreMesh>& cores,
                    const CoreOptions& options = {})
{
    try {
        prepare_cores(mesh, "skin", cores, options);
    } catch (const GeometryError& error) {
        return error.what();
    }
    return "not refused";
}

TEST(Cores, ASphereIsFilledUpToTheSphereInside)
{
    const TriangleMesh skin = test::icosphere(1, 3);
    const CoreMesh core = ball(0.5);
    const ShellResult result = build(skin, {core});
    expect_clear(result);
    const double between = volume(skin) - volume(core.mesh);
    EXPECT_DOUBLE_EQ(result.report.solid_volume, between);
    EXPECT_LT(result.report.shell_volume, between);
    EXPECT_GT(result.report.fill, 0.98);
    EXPECT_EQ(result.stack.surface(0), skin.points);
    EXPECT_EQ(result.stack.triangles(), skin.triangles);
    EXPECT_EQ(result.report.cores->cores[0].name, "ball");
    EXPECT_GT(result.report.cores->least_distance, 0);
}

TEST(Cores, ACapsuleHasTwoBones)
{
    const std::vector<CoreMesh> bones{ball(0.4, Vec3d(0, 0, 1.2)), ball(0.3, Vec3d(0.1, 0, -1))};
    const ShellResult result = build(test::capsule(), bones);
    expect_clear(result);
    EXPECT_GT(result.report.fill, 0.95);
    ASSERT_EQ(result.report.cores->cores.size(), 2U);
    for (const CoreFigures& core : result.report.cores->cores)
        EXPECT_GT(core.ended, 100U);
}

TEST(Cores, OneFileMayHoldSeveralParts)
{
    const CoreMesh bones{
        "bones", test::joined(ball(0.4, Vec3d(0, 0, 1.2)).mesh, ball(0.3, Vec3d(0.1, 0, -1)).mesh)};
    const ShellResult result = build(test::capsule(), {bones});
    expect_clear(result);
    EXPECT_EQ(result.report.cores->cores[0].parts, 2U);
}

TEST(Cores, MayHaveAHandleAndBeThin)
{
    expect_clear(build(test::icosphere(1, 3), {{"ring", test::torus(0.5, 0.1, 24, 8)}}));
    expect_clear(
        build(test::icosphere(1, 3),
              {{"plate", test::gridded_box(Vec3d(-0.5, -0.5, 0), Vec3d(0.5, 0.5, 1e-3), 4)}}));
}

TEST(Cores, TaperedShellsAndLayersStayOffThem)
{
    for (const auto& [layers, core] :
         {std::pair(1, CoreSurface::free), std::pair(2, CoreSurface::free),
          std::pair(1, CoreSurface::stitched), std::pair(2, CoreSurface::stitched)}) {
        SCOPED_TRACE(std::to_string(layers) + (core == CoreSurface::free ? " free" : " stitched"));
        ShellOptions options = coarse_field();
        options.layers.layers = layers;
        options.taper.wanted = true;
        options.taper.core = core;
        const ShellResult result = build(
            test::capsule(), {ball(0.4, Vec3d(0, 0, 1.2)), ball(0.3, Vec3d(0.1, 0, -1))}, options);
        expect_clear(result);
        EXPECT_FALSE(result.report.taper->undone);
        EXPECT_TRUE(result.stack.tapered);
        const auto& by_tets = result.report.taper->prisms_by_tets;
        EXPECT_EQ(by_tets[0] + by_tets[1] + by_tets[2] + by_tets[3], result.report.prisms);
        EXPECT_EQ(by_tets[1] + 2 * by_tets[2] + 3 * by_tets[3], result.report.signs.tets);
        EXPECT_LT(result.report.signs.tets, 3 * result.report.prisms);
    }
}

TEST(Cores, LayersAreCutAboveThem)
{
    ShellOptions options = coarse_field();
    options.layers.layers = 2;
    const ShellResult result = build(test::icosphere(1, 3), {ball(0.5)}, options);
    expect_clear(result);
    EXPECT_EQ(result.stack.layers.size(), 2U);
    EXPECT_GT(result.report.fill, 0.98);
}

TEST(Cores, TheThickestMethodScaledShellsAndRefinementKnowThem)
{
    ShellOptions thickest = coarse_field(), scaled = thickest, refined = thickest;
    thickest.grow.method = Method::thickest;
    scaled.scale.factor = 0.5;
    refined.refine.rounds = 1;
    refined.refine.by = RefineBy::area;
    const TriangleMesh skin = test::icosphere(1, 2);
    const ShellResult full = build(skin, {ball(0.5)}, thickest);
    EXPECT_EQ(test::tets_that_meet(full.tets, full.cores->kept_out), 0U);
    EXPECT_TRUE(full.report.certificate->certified());
    const ShellResult half = build(skin, {ball(0.5)}, scaled);
    expect_clear(half);
    EXPECT_LT(half.report.fill, 0.8);
    const ShellResult finer = build(skin, {ball(0.5)}, refined);
    expect_clear(finer);
    EXPECT_GT(finer.surface.triangles.size(), skin.triangles.size());
    EXPECT_EQ(finer.report.mesh.triangles, finer.surface.triangles.size());
}

TEST(Cores, TheDistanceIsKept)
{
    const CoreMesh core = ball(0.3);
    const auto of_sphere = [](double radius) { return 4 * kPi / 3 * std::pow(radius, 3); };
    for (const double distance : {0.05, 0.1, 0.3}) {
        SCOPED_TRACE(distance);
        ShellOptions options = coarse_field();
        options.cores.distance = distance;
        const ShellResult result = build(test::icosphere(1, 3), {core}, options);
        expect_clear(result);
        EXPECT_GE(result.report.cores->least_distance, distance);
        // And no more than a voxel or two of the distance's own is given away.
        EXPECT_LT(result.report.cores->least_distance, 1.5 * distance + 0.005);
        EXPECT_GT(result.report.shell_volume, 0.93 * (of_sphere(1) - of_sphere(0.3 + distance)));
    }
}

TEST(Cores, TheDistanceIsKeptAroundWhatIsThinnerThanIt)
{
    // A needle that no voxel has its centre in.
    const CoreMesh needle{"needle", test::box(Vec3d(-0.3, 0.011, 0.012), Vec3d(0.3, 0.012, 0.013))};
    ShellOptions options = coarse_field();
    options.cores.distance = 0.2;
    const ShellResult result = build(test::icosphere(1, 3), {needle}, options);
    expect_clear(result);
    EXPECT_GE(result.report.cores->least_distance, 0.2);
    EXPECT_LT(result.report.cores->least_distance, 0.3);
}

TEST(Cores, GrowthOnCoarserSurfacesIsThatOfTheSkin)
{
    // More triangles than growth begins with.
    const ShellResult result = build(test::icosphere(1, 4), {ball(0.5, Vec3d(0.1, 0, 0), 3)});
    expect_clear(result);
    EXPECT_GT(result.report.fill, 0.98);
}

TEST(Cores, SameBytesForAnyNumberOfThreads)
{
    const auto tets_with = [](std::size_t threads) {
        const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
        ShellOptions options = coarse_field();
        options.cores.distance = 0.05;
        return build(test::capsule(), {ball(0.4, Vec3d(0, 0, 1.2)), ball(0.3, Vec3d(0.1, 0, -1))},
                     options);
    };
    const ShellResult one = tets_with(1), four = tets_with(4);
    EXPECT_EQ(one.tets.points, four.tets.points);
    EXPECT_EQ(one.tets.tets, four.tets.tets);
    EXPECT_EQ(report_json(one.report, false), report_json(four.report, false));
    ASSERT_EQ(one.core_feet.size(), four.core_feet.size());
    for (std::size_t v = 0; v < one.core_feet.size(); ++v) {
        EXPECT_EQ(one.core_feet[v].triangle, four.core_feet[v].triangle) << v;
        EXPECT_EQ(one.core_feet[v].uvw, four.core_feet[v].uvw) << v;
    }
}

TEST(Cores, OneThatCrossesTheSurfaceIsRefusedByTriangles)
{
    const TriangleMesh skin = test::box(Vec3d(-1), Vec3d(1));
    // Above the middle of the box's face, which is cut into two triangles.
    const std::string message = refusal(
        skin, {ball(0.2), {"thorn", test::box(Vec3d(-0.1, -0.2, 0.8), Vec3d(0.1, -0.1, 1.2))}});
    EXPECT_THAT(message, AllOf(HasSubstr("core thorn crosses or touches the surface: triangle "),
                               HasSubstr(" of skin and triangle "), HasSubstr(" of core thorn")));
}

TEST(Cores, TouchingIsCrossing)
{
    EXPECT_THAT(refusal(test::box(Vec3d(-1), Vec3d(1)),
                        {{"box", test::box(Vec3d(-0.5, -0.5, 0), Vec3d(0.5, 0.5, 1))}}),
                HasSubstr("core box crosses or touches the surface"));
}

TEST(Cores, WhatIsNoCoreIsRefusedByName)
{
    const TriangleMesh skin = test::icosphere(1, 3);
    EXPECT_THAT(refusal(skin, {ball(0.2, Vec3d(5, 0, 0))}),
                HasSubstr("core ball: the part of triangle 0 lies outside of skin"));
    EXPECT_THAT(refusal(skin, {{"open", test::without_triangle(ball(0.2).mesh, 7)}}),
                HasSubstr("core open: it is open: 3 found"));
    EXPECT_THAT(refusal(skin, {{"turned", test::reversed(ball(0.2).mesh)}}),
                HasSubstr("core turned: the part of triangle 0 is inside out"));
    EXPECT_THAT(refusal(skin, {ball(0.5), {"inner", ball(0.2).mesh}}),
                HasSubstr("core inner: the part of triangle 0 lies inside core ball"));
    EXPECT_THAT(refusal(skin, {{"inner", ball(0.2).mesh}, ball(0.5)}),
                HasSubstr("core inner: the part of triangle 0 lies inside core ball"));
    EXPECT_THAT(refusal(skin, {{"hollow", test::joined(ball(0.5).mesh, ball(0.2).mesh)}}),
                HasSubstr("core hollow: the part of triangle 320 lies inside another part"));
    EXPECT_THAT(refusal(skin, {ball(0.3), {"other", ball(0.3, Vec3d(0.4, 0, 0)).mesh}}),
                HasSubstr("core other crosses or touches core ball: triangle "));
    EXPECT_THAT(refusal(skin, {{"none", {}}}), HasSubstr("core none: it has no triangles"));
}

TEST(Cores, ACavityMayStandBesideOneButNotInIt)
{
    const TriangleMesh hollow =
        test::joined(test::icosphere(1, 3), test::reversed(test::icosphere(0.2, 2)));
    expect_clear(build(hollow, {ball(0.2, Vec3d(0.6, 0, 0))}));
    EXPECT_THAT(refusal(hollow, {ball(0.5)}),
                HasSubstr("core ball: a part of skin lies inside it, that of triangle 1280"));
    EXPECT_THAT(refusal(hollow, {ball(0.1)}), HasSubstr("lies outside of skin"));
    CoreOptions options;
    options.distance = 0.5; // around the core and the cavity beside it, without touching its wall
    EXPECT_THAT(refusal(test::joined(test::icosphere(2, 3),
                                     test::reversed(test::translated(test::icosphere(0.1, 2),
                                                                     Vec3d(0.4, 0, 0)))),
                        {ball(0.2)}, options),
                HasSubstr("the surface comes nearer to a core than 0.5"));
}

TEST(Cores, ADistanceThatTheSurfaceDoesNotKeepIsRefused)
{
    CoreOptions options;
    options.distance = 0.4;
    EXPECT_THAT(
        refusal(test::icosphere(1, 3), {ball(0.2, Vec3d(0.5, 0, 0))}, options),
        AllOf(HasSubstr("the surface comes nearer to a core than 0.4"), HasSubstr("at triangle ")));
    options.distance = 3;
    EXPECT_THAT(refusal(test::icosphere(1, 3), {ball(0.2)}, options),
                HasSubstr("the surface comes nearer to a core than 3"));
    options.distance = -1;
    EXPECT_THROW(prepare_cores(test::icosphere(1, 3), "skin", {ball(0.2)}, options), InvalidOption);
}

TEST(Cores, AreForGrownShellsInside)
{
    const auto refused = [](const std::function<void(ShellOptions&)>& change, const char* why) {
        ShellOptions options = coarse_field();
        change(options);
        try {
            build(test::icosphere(1, 2), {ball(0.3)}, options);
            ADD_FAILURE() << why;
        } catch (const InvalidOption& error) {
            EXPECT_THAT(error.what(), HasSubstr(why));
        }
    };
    refused([](ShellOptions& o) { o.side = Side::both; }, "--side");
    refused([](ShellOptions& o) { o.side = Side::outward; }, "--side");
    refused([](ShellOptions& o) { o.grow.method = Method::raw; }, "--method");
    refused([](ShellOptions& o) { o.check.allow_self_intersections = true; },
            "--allow-self-intersections");
}

TEST(Cores, LookingAtThemCanBeCancelled)
{
    const TriangleMesh skin = test::icosphere(1, 2);
    test::expect_cancelled([&](Interrupter* interrupter) {
        prepare_cores(skin, "skin", {ball(0.5)}, {}, interrupter);
    });
}

} // namespace
