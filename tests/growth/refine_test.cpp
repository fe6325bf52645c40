// SPDX-License-Identifier: Apache-2.0
#include "vdb_shell/growth/refine.h"

#include "growth/void_volumes.h"
#include "vdb_shell/core/error.h"
#include "vdb_shell/pipeline.h"

#include "support/files.h"
#include "support/shapes.h"
#include "support/shells.h"
#include "support/stacks.h"
#include "vdb_shell/io/read_mesh.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <numeric>
#include <string>

namespace vdb_shell::test
{
namespace
{

/// A sphere of 80 triangles, flattened and bent: its medial axis is a curved sheet, which so few
/// vertices cannot follow.
TriangleMesh bent_disc()
{
    TriangleMesh mesh = icosphere(1.0, 1);
    for (openvdb::Vec3s& p : mesh.points)
        p = {2 * p[0], p[1], 0.4F * p[2] + 1.6F * p[0] * p[0]};
    return mesh;
}

ShellOptions refining(int rounds)
{
    ShellOptions options;
    options.level_set.resolution = 40;
    options.coverage.samples = 5000;
    options.refine.rounds = rounds;
    return options;
}

void expect_certified(const ShellResult& result)
{
    EXPECT_EQ(result.report.certificate->failures(), std::vector<std::string>{});
    EXPECT_TRUE(result.report.conformity.conforming());
    EXPECT_EQ(result.report.coverage.in_several, 0U);
    EXPECT_TRUE(result.report.mesh.closed() && result.report.mesh.manifold() &&
                result.report.mesh.embedded());
    EXPECT_EQ(result.report.mesh.triangles, result.surface.triangles.size());
}

TEST(Refine, VoidUnderARadialShellIsWhatTheInnerSphereEncloses)
{
    const TriangleMesh sphere = icosphere(1.0, 3);
    const PrismShell shell = radial_shell(sphere, [](std::size_t) { return 0.75; });
    const std::vector<double> voids = void_volumes(shell);
    // Rays from each place reach through the middle to the other side: area times radius, three
    // times the volume of the ball, 1/64 of the solid.
    const double ball = signed_volume(sphere.points, sphere.triangles) / 64;
    EXPECT_NEAR(std::accumulate(voids.begin(), voids.end(), 0.0), 3 * ball, 0.02 * ball);
}

TEST(Refine, VoidBetweenSheetsIsSharedByThem)
{
    const TriangleMesh slab = gridded_box({0, 0, 0}, {8, 8, 1}, 8);
    // All points move to the sheets z = 0.2 and z = 0.8.
    const PrismShell shell = shell_along(
        slab, [](const openvdb::Vec3d& p) { return openvdb::Vec3d(0, 0, p[2] < 0.5 ? 1 : -1); },
        [&](std::size_t v) { return slab.points[v][2] == 0 || slab.points[v][2] == 1 ? 0.2 : 0; });
    const std::vector<double> voids = void_volumes(shell);
    for (std::size_t t = 0; t < voids.size(); ++t) {
        const openvdb::Vec3I& c = slab.triangles[t];
        const bool top =
            slab.points[c[0]][2] == 1 && slab.points[c[1]][2] == 1 && slab.points[c[2]][2] == 1;
        if (top) { // half of the 0.6 between them, on half a unit square
            EXPECT_NEAR(voids[t], 0.5 * 0.3, 1e-6);
        }
    }
}

TEST(Refine, TakesTheFewestTrianglesThatMakeUpTheShare)
{
    const std::vector<double> gain{1, 4, 0, 3, 2};
    EXPECT_EQ(triangles_to_cut(gain, 0.4), (std::vector<std::uint32_t>{1}));
    EXPECT_EQ(triangles_to_cut(gain, 0.5), (std::vector<std::uint32_t>{1, 3}));
    EXPECT_EQ(triangles_to_cut(gain, 1.0), (std::vector<std::uint32_t>{1, 3, 4, 0}));
    EXPECT_TRUE(triangles_to_cut({0, 0}, 1.0).empty());
}

TEST(Refine, ContactsMarkTheShortPillarThatIsHeldBack)
{
    const TriangleMesh sphere = icosphere(1.0, 2);
    PrismShell shell = radial_shell(sphere, [](std::size_t v) { return v == 20 ? 0.2 : 0.5; });
    const auto marked = [&] {
        return triangles_to_cut(refinement_gain(shell, RefineBy::contacts), 1.0);
    };
    EXPECT_TRUE(marked().empty()); // held by the thickness: the user's wish
    shell.stop[20] = StopReason::inner_contact;
    const std::vector<std::uint32_t> found = marked();
    EXPECT_FALSE(found.empty());
    for (const std::uint32_t t : found) {
        const openvdb::Vec3I& c = sphere.triangles[t];
        EXPECT_TRUE(c[0] == 20 || c[1] == 20 || c[2] == 20);
    }
}

TEST(Refine, GrowsOnToMoreFillAndStaysCertified)
{
    const TriangleMesh mesh = bent_disc();
    for (const GrowOptions& way : test::ways_to_grow()) {
        ShellOptions options = refining(3);
        options.grow = way;
        const ShellResult result = build_shell(mesh, options);
        expect_certified(result);
        const RefineReport& refine = *result.report.refine;
        ASSERT_EQ(refine.rounds.size(), 4U);
        EXPECT_EQ(refine.end, RefineEnd::rounds);
        EXPECT_EQ(refine.rounds[0].triangles, mesh.triangles.size());
        const RefineRound& kept = refine.rounds[refine.kept];
        EXPECT_DOUBLE_EQ(result.report.fill, kept.fill);
        EXPECT_EQ(result.report.signs.tets, kept.tets);
        for (const RefineRound& round : refine.rounds)
            EXPECT_LE(round.fill, kept.fill);
        EXPECT_GT(kept.fill, refine.rounds[0].fill);
        EXPECT_NEAR(refine.gain_per_tet(1) * double(refine.rounds[1].tets - refine.rounds[0].tets),
                    refine.rounds[1].fill - refine.rounds[0].fill, 1e-12);
        // The shape is the input's.
        EXPECT_NEAR(result.report.solid_volume, signed_volume(mesh.points, mesh.triangles), 1e-5);
        EXPECT_LT(surface_distance(result.surface, mesh, 0.1).max, 5e-7);
        EXPECT_LT(surface_distance(mesh, result.surface, 0.1).max, 5e-7);
    }
}

TEST(Refine, ARawShellIsMadeOfTheRefinedSurfacesOwnLines)
{
    ShellOptions options = refining(1);
    options.grow.method = Method::raw;
    const ShellResult result = build_shell(test::icosphere(1.0, 2), options);
    ASSERT_EQ(result.report.refine->kept, 1U);
    EXPECT_GT(result.surface.points.size(), test::icosphere(1.0, 2).points.size());
    EXPECT_EQ(result.report.lines.lines, result.surface.points.size());
    EXPECT_EQ(result.tets.tets.size(), 3 * result.surface.triangles.size());
    EXPECT_GT(result.report.fill, 0.5);
}

TEST(Refine, BeatsUniformSubdivisionTetForTet)
{
    VDB_SHELL_NEEDS_REAL_MESHES();
    const TriangleMesh cow = read_mesh(real_meshes() / "paper/cow.obj").mesh;
    ShellOptions uniform = refining(0);
    uniform.subdivide.levels = 1;
    ShellOptions adaptive = refining(1);
    const ShellResult four = build_shell(cow, uniform), some = build_shell(cow, adaptive);
    expect_certified(some);
    EXPECT_LT(some.tets.tets.size(), four.tets.tets.size() / 2 + 1000);
    const RefineRound& before = some.report.refine->rounds[0];
    EXPECT_GT(some.report.fill, before.fill + 0.002);
    const auto gain_per_tet = [&](const ShellResult& result) {
        return (result.report.fill - before.fill) / double(result.tets.tets.size() - before.tets);
    };
    EXPECT_GT(gain_per_tet(some), 1.5 * gain_per_tet(four));
}

TEST(Refine, EndsWhereItIsTold)
{
    const TriangleMesh mesh = bent_disc();
    ShellOptions options = refining(5);
    options.refine.max_tets = 600;
    ShellResult result = build_shell(mesh, options);
    EXPECT_EQ(result.report.refine->end, RefineEnd::max_tets);
    for (const RefineRound& round : result.report.refine->rounds)
        EXPECT_LE(round.tets, 600U);
    options.refine.max_tets = 10; // fewer than there are: the shell is built all the same
    result = build_shell(mesh, options);
    EXPECT_EQ(result.report.refine->end, RefineEnd::max_tets);
    EXPECT_EQ(result.report.refine->rounds.size(), 1U);
    EXPECT_EQ(result.surface.triangles, mesh.triangles);

    options = refining(5);
    options.refine.target_fill = 0.1;
    result = build_shell(mesh, options);
    EXPECT_EQ(result.report.refine->end, RefineEnd::target_fill);
    EXPECT_EQ(result.report.refine->rounds.size(), 1U);

    options = refining(5);
    options.refine.min_gain = 1.0;
    result = build_shell(mesh, options);
    EXPECT_EQ(result.report.refine->end, RefineEnd::small_gain);
    EXPECT_EQ(result.report.refine->rounds.size(), 2U);

    options = refining(1);
    options.refine.target_fill = 1.0; // cannot be had: the report says what was
    result = build_shell(mesh, options);
    EXPECT_EQ(result.report.refine->end, RefineEnd::rounds);
    EXPECT_LT(result.report.fill, 1.0);
}

TEST(Refine, KeepsTheThicknessAndTheLayers)
{
    ShellOptions options = refining(2);
    options.side = Side::both;
    options.line_step.thickness = 0.3;
    options.layers.layers = 2;
    options.refine.by = RefineBy::area;
    const ShellResult result = build_shell(bent_disc(), options);
    expect_certified(result);
    EXPECT_LE(result.report.lines.length.max, 0.3);
    const RefineReport& refine = *result.report.refine;
    EXPECT_EQ(result.report.signs.tets, refine.rounds[refine.kept].tets);
    EXPECT_NEAR(result.report.fill, refine.rounds[refine.kept].fill, 1e-12);
}

TEST(Refine, SameBytesForAnyNumberOfThreads)
{
    const TriangleMesh mesh = bent_disc();
    const auto built = [&](int threads, RefineBy by) {
        const tbb::global_control limit(tbb::global_control::max_allowed_parallelism,
                                        std::size_t(threads));
        ShellOptions options = refining(2);
        options.refine.by = by;
        return build_shell(mesh, options);
    };
    for (const RefineBy by : {RefineBy::contacts, RefineBy::voids, RefineBy::area}) {
        const ShellResult one = built(1, by), four = built(4, by);
        EXPECT_EQ(one.tets.points, four.tets.points);
        EXPECT_EQ(one.tets.tets, four.tets.tets);
        EXPECT_EQ(report_json(one.report, false), report_json(four.report, false));
    }
}

TEST(Refine, RefusesOptionsByName)
{
    const auto message = [](auto change) -> std::string {
        ShellOptions options = refining(1);
        change(options);
        try {
            build_shell(bent_disc(), options);
        } catch (const InvalidOption& error) {
            return error.what();
        }
        return "";
    };
    const auto expect = [&](auto change, const std::string& part) {
        EXPECT_NE(message(change).find(part), std::string::npos) << message(change);
    };
    expect([](ShellOptions& o) { o.refine.rounds = -1; }, "rounds is -1");
    expect([](ShellOptions& o) { o.refine.share = 0; }, "share is 0");
    expect([](ShellOptions& o) { o.refine.share = 1.5; }, "share is 1.5");
    expect([](ShellOptions& o) { o.refine.target_fill = 1.2; }, "target_fill is 1.2");
    expect([](ShellOptions& o) { o.refine.min_gain = -0.1; }, "min_gain is -0.1");
    expect([](ShellOptions& o) { o.side = Side::outward; }, "outward shell");
    expect([](ShellOptions& o) { o.decimate.triangles = 2; }, "triangles is 2");
    expect([](ShellOptions& o) { o.subdivide.levels = -2; }, "levels is -2");
}

} // namespace
} // namespace vdb_shell::test
