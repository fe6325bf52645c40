// SPDX-License-Identifier: Apache-2.0
#include "vdb_shell/pose/pose_shell.h"

#include "vdb_shell/core/error.h"
#include "vdb_shell/pipeline.h"

#include "support/bends.h"
#include "support/cancelled.h"
#include "support/grids.h"
#include "support/tapered.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>

namespace vdb_shell
{
namespace
{

using openvdb::Vec3d;
using openvdb::Vec3s;
using test::Points;

ShellStack built(const TriangleMesh& mesh, const ShellOptions& more = {})
{
    ShellOptions options = more;
    options.level_set.resolution = 32;
    options.coverage.samples = 0;
    ShellResult result = build_shell(mesh, options);
    EXPECT_TRUE(result.report.certificate->certified());
    return std::move(result.stack);
}

/// The posed shell, certified, with the tets of the shell at rest.
PosedShell expect_certified(const RestShell& rest, const Points& skin)
{
    PosedShell posed = build_posed(rest, skin, {});
    EXPECT_TRUE(posed.report.certificate->certified())
        << ::testing::PrintToString(posed.report.certificate->failures());
    EXPECT_EQ(posed.tets.tets, rest.tets().tets);
    EXPECT_EQ(posed.stack.surface(posed.stack.skin), skin);
    EXPECT_TRUE(find_overlaps(posed.tets).none());
    return posed;
}

Points elbow_of(const TriangleMesh& mesh, double angle_radians)
{
    return test::moved(mesh.points,
                       [=](const Vec3d& p) { return test::elbow(p, angle_radians, 1.0); });
}

TEST(PoseShell, AtRestEveryBitStays)
{
    const TriangleMesh rod = test::round_rod();
    for (const int layers : {1, 3}) {
        ShellOptions options;
        options.layers.layers = layers;
        const RestShell rest(built(rod, options));
        const PosedShell posed = expect_certified(rest, rod.points);
        for (std::size_t k = 0; k < rest.stack().surfaces(); ++k)
            EXPECT_EQ(posed.stack.surface(k), rest.stack().surface(k)) << k;
        EXPECT_EQ(posed.report.pose->moved_points, 0U);
    }
}

TEST(PoseShell, ARigidMotionMovesAllAlike)
{
    const TriangleMesh rod = test::round_rod();
    const RestShell rest(built(rod));
    const Points skin = test::turned(rod, {0, 1, 1}, 1.0).points;
    const PosedShell posed = expect_certified(rest, skin);
    const TriangleMesh inner{rest.stack().surface(1), rod.triangles};
    const Points expected = test::turned(inner, {0, 1, 1}, 1.0).points;
    for (std::size_t v = 0; v < expected.size(); ++v)
        EXPECT_LT((posed.stack.surface(1)[v] - expected[v]).length(), 1e-4f) << v;
}

TEST(PoseShell, BentAndTwistedItIsCertifiedWithItsTets)
{
    const TriangleMesh rod = test::round_rod();
    const RestShell rest(built(rod));
    for (const double angle : {0.5, 1.0, 1.5, 2.0}) {
        const PosedShell posed = expect_certified(rest, elbow_of(rod, angle));
        EXPECT_EQ(posed.report.pose->lost_pillars, 0U);
        EXPECT_GT(posed.report.fill, 0.9);
    }
    for (const double turn : {0.5, 1.0})
        expect_certified(
            rest, test::moved(rod.points, [=](const Vec3d& p) { return test::twist(p, turn); }));
}

TEST(PoseShell, SquashedAndStretchedItIsCertified)
{
    const TriangleMesh torus = test::torus(1.0, 0.4, 24, 12);
    const RestShell rest(built(torus));
    for (const double share : {0.4, 2.5})
        expect_certified(rest, test::moved(torus.points, [=](const Vec3d& p) {
                             return Vec3d(p[0] / std::sqrt(share), p[1] / std::sqrt(share),
                                          p[2] * share);
                         }));
}

TEST(PoseShell, LayersOutwardShellsAndBothSides)
{
    const TriangleMesh rod = test::round_rod();
    for (const Side side : {Side::inward, Side::outward, Side::both}) {
        ShellOptions options;
        options.side = side;
        options.layers.layers = 2;
        const RestShell rest(built(rod, options));
        expect_certified(rest, elbow_of(rod, 1.0));
    }
}

TEST(PoseShell, TaperedShellsKeepTheirSharedPointsAndAreCertified)
{
    const TriangleMesh rod = test::round_rod();
    for (const CoreSurface core : {CoreSurface::free, CoreSurface::stitched}) {
        ShellOptions options;
        options.taper.wanted = true;
        options.taper.core = core;
        const RestShell rest(built(rod, options));
        for (const double angle : {0.3, 0.6, 0.9}) {
            const PosedShell posed = expect_certified(rest, elbow_of(rod, angle));
            EXPECT_EQ(posed.report.pose->faces_not_apart, 0U);
        }
    }
}

TEST(PoseShell, PointsOfATaperedShellToWhichTheSkinLeavesNoPlaceAreCounted)
{
    const TriangleMesh rod = test::round_rod();
    ShellOptions options;
    options.taper.wanted = true;
    const RestShell rest(built(rod, options));
    // Inside out: no tet on the skin can be positive.
    const Points skin =
        test::moved(rod.points, [](const Vec3d& p) { return Vec3d(-p[0], p[1], p[2]); });
    const PoseReport pose = pose_shell(rest, skin).report;
    EXPECT_GT(pose.lost_demanded, 0U);
    EXPECT_LE(pose.lost_demanded, pose.lost_pillars);
    EXPECT_GT(pose.inverted, 0U);
}

/// A box of which each triangle has one tet, with a second layer that is a point elsewhere and has
/// none.
ShellStack with_a_layer_of_one_point(const TriangleMesh& box)
{
    ShellOptions options;
    options.taper.wanted = true;
    options.taper.core = CoreSurface::stitched;
    options.taper.tet_cost = 32;
    options.taper.void_cost = 80;
    ShellStack stack = built(box, options);
    const Points& centre = stack.layers.front().inner;
    EXPECT_EQ(std::count(centre.begin(), centre.end(), centre.front()),
              std::ptrdiff_t(centre.size()));
    PrismShell below = stack.layers.front();
    below.outer = centre;
    below.inner.assign(centre.size(), centre.front() + Vec3s(0.1f, 0.2f, 0.05f));
    stack.layers.push_back(below);
    stack.splits.push_back(stack.splits.front());
    return stack;
}

TEST(PoseShell, ALayerOfOnePointHasNoTetInAnyPose)
{
    const TriangleMesh box = test::box(Vec3d(0), Vec3d(1, 2, 3));
    const ShellStack stack = with_a_layer_of_one_point(box);
    const RestShell rest(stack);
    EXPECT_EQ(rest.tets().tets.size(), box.triangles.size());
    const PosedShell still = expect_certified(rest, box.points);
    EXPECT_EQ(still.stack.surface(2), stack.surface(2));
    expect_certified(rest, elbow_of(box, 0.3));
}

TEST(PoseShell, ThinLayersFarFromTheOriginSurviveTheirRounding)
{
    const TriangleMesh rod = test::translated(test::round_rod(), {3000, 0, 0});
    ShellOptions options;
    options.layers.layers = 24;
    options.layers.grading = 1.3;
    const RestShell rest(built(rod, options));
    const Points skin = test::moved(rod.points, [](const Vec3d& p) {
        return test::elbow(p - Vec3d(3000, 0, 0), 1.0, 1.0) + Vec3d(3000, 0, 0);
    });
    EXPECT_EQ(pose_shell(rest, skin).report.inverted, 0U);
}

TEST(PoseShell, PinsStayPins)
{
    TriangleMesh rod = test::round_rod();
    ShellStack stack = built(rod);
    stack.layers[0].inner[40] = stack.layers[0].outer[40];
    const RestShell rest(stack);
    const PosedShell posed = build_posed(rest, elbow_of(rod, 1.0), {});
    EXPECT_TRUE(posed.stack.layers[0].pinned(40));
    EXPECT_EQ(posed.report.pinned_vertices, 1U);
}

TEST(PoseShell, ASkinThatCrossesItselfKeepsPositiveTetsAndTheRestIsCertifiedTetByTet)
{
    // Two rods, of which one is pushed through the other.
    const TriangleMesh one = test::round_rod();
    const TriangleMesh both = test::joined(one, test::translated(one, {1.5, 0, 0}));
    const RestShell rest(built(both));
    const Points skin = test::moved(
        both.points, [](const Vec3d& p) { return p[0] > 0.75 ? p - Vec3d(0.8, 0, 0) : p; });
    const PosedShell posed = build_posed(rest, skin, {});
    EXPECT_GT(posed.report.pose->skin_crossings, 0U);
    EXPECT_GT(posed.report.pose->excused_triangles, 0U);
    EXPECT_FALSE(posed.report.certificate->certified());
    EXPECT_TRUE(posed.report.certificate->locally_valid());
    EXPECT_EQ(posed.report.signs.inverted.count, 0U);
    // Both were only pushed, so nothing had to move.
    EXPECT_EQ(posed.report.pose->moved_points, 0U);
    EXPECT_GT(posed.report.overlaps->certified_tets(), posed.tets.tets.size() / 4);
}

TEST(PoseShell, SameBitsForAnyNumberOfThreads)
{
    const TriangleMesh rod = test::round_rod();
    const RestShell rest(built(rod));
    const Points skin = elbow_of(rod, 1.8);
    const PoseResult all = pose_shell(rest, skin);
    const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
    const PoseResult alone = pose_shell(rest, skin);
    EXPECT_EQ(all.stack.surface(1), alone.stack.surface(1));
}

TEST(PoseShell, AFrameDoesNotDependOnThoseBeforeAndMovesNoFartherThanItsSkin)
{
    const TriangleMesh rod = test::round_rod();
    const RestShell rest(built(rod));
    const Points before = pose_shell(rest, elbow_of(rod, 0.80)).stack.surface(1);
    const Points now = pose_shell(rest, elbow_of(rod, 0.81)).stack.surface(1);
    EXPECT_EQ(pose_shell(rest, elbow_of(rod, 0.80)).stack.surface(1), before);
    double skin = 0, inner = 0;
    const Points a = elbow_of(rod, 0.80), b = elbow_of(rod, 0.81);
    for (std::size_t v = 0; v < a.size(); ++v) {
        skin = std::max(skin, double((b[v] - a[v]).length()));
        inner = std::max(inner, double((now[v] - before[v]).length()));
    }
    EXPECT_LT(inner, 1.5 * skin);
}

TEST(PoseShell, WhatCannotBeIsRefused)
{
    const TriangleMesh sphere = test::icosphere(1.0, 1);
    const RestShell rest(built(sphere));
    Points skin = sphere.points;
    skin.pop_back();
    EXPECT_THROW(pose_shell(rest, skin), InvalidOption);
    skin.push_back(Vec3s(std::nanf("")));
    EXPECT_THROW(pose_shell(rest, skin), InvalidOption);
    PoseOptions options;
    options.rounds = -1;
    EXPECT_THROW(pose_shell(rest, sphere.points, options), InvalidOption);
    options = {};
    options.most_distortion = 1;
    EXPECT_THROW(pose_shell(rest, sphere.points, options), InvalidOption);
}

TEST(PoseShell, CanBeCancelled)
{
    const TriangleMesh rod = test::round_rod();
    const RestShell rest(built(rod));
    const Points skin = elbow_of(rod, 1.0);
    test::expect_cancelled(
        [&](Interrupter* interrupter) { pose_shell(rest, skin, {}, interrupter); });
    test::expect_cancelled(
        [&](Interrupter* interrupter) { build_posed(rest, skin, {}, "pose", interrupter); });
    const PoseResult made = pose_shell(rest, skin);
    test::expect_cancelled(
        [&](Interrupter* interrupter) { finish_posed(rest, skin, made, "pose", interrupter); });
    ShellFile file;
    file.stack = rest.stack();
    file.tets = rest.tets();
    file.surface = test::sphere_level_set(1.0f, 0.2f);
    const PosedShell posed = finish_posed(rest, skin, made);
    test::expect_cancelled(
        [&](Interrupter* interrupter) { posed_file(file, posed, true, interrupter); });
}

} // namespace
} // namespace vdb_shell
