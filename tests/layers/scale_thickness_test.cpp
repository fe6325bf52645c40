// SPDX-License-Identifier: Apache-2.0
#include "vdb_shell/layers/scale_thickness.h"

#include "core/exact.h"
#include "support/broken_shells.h"
#include "support/stacks.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <utility>

namespace
{

using namespace vdb_shell;
using openvdb::Vec3d;
using openvdb::Vec3s;
using test::icosphere;
using test::SplitShell;

ScaleOptions by(double factor)
{
    ScaleOptions options;
    options.factor = factor;
    return options;
}

/// No pillar is longer than the factor allows, the outer surface stays, and the report counts what
/// it says it counts.
void expect_scaled(const PrismShell& before, const PrismShell& after, double factor,
                   const ScaleReport& report)
{
    EXPECT_EQ(after.outer, before.outer);
    EXPECT_EQ(after.triangles, before.triangles);
    std::size_t pinned = 0, shortened = 0;
    for (std::size_t v = 0; v < before.outer.size(); ++v) {
        const double wanted = factor * before.length(v);
        EXPECT_FALSE(exact::longer_than(after.outer[v], after.inner[v], wanted)) << v;
        if (before.pinned(v)) {
            EXPECT_TRUE(after.pinned(v)) << v;
            EXPECT_EQ(after.stop[v], before.stop[v]) << v;
            continue;
        }
        pinned += after.pinned(v);
        EXPECT_EQ(after.stop[v], after.pinned(v) ? StopReason::pinned : before.stop[v]) << v;
        const double float_size =
            std::max({std::abs(before.outer[v][0]), std::abs(before.outer[v][1]),
                      std::abs(before.outer[v][2]), 1e-30f}) *
            1e-6;
        shortened += after.length(v) < wanted - float_size;
    }
    EXPECT_EQ(report.pinned, pinned);
    EXPECT_EQ(report.shortened, shortened);
}

ScaleReport scaled(PrismShell& shell, const PrismSplit& split, double factor, PrismTest test)
{
    const PrismShell before = shell;
    const ScaleReport report = scale_thickness(shell, split, by(factor), test);
    expect_scaled(before, shell, factor, report);
    return report;
}

TEST(ScaleThickness, HalvesABoxsPillarsExactly)
{
    SplitShell box = test::scaled_shell(test::box(Vec3d(-8), Vec3d(8)), 0.25f);
    const ScaleReport report = scaled(box.shell, box.split, 0.5, PrismTest::twelve_tets);
    EXPECT_EQ(report.shortened, 0U);
    for (std::size_t v = 0; v < 8; ++v)
        for (int k = 0; k < 3; ++k)
            EXPECT_NEAR(box.shell.inner[v][k], 0.625f * box.shell.outer[v][k], 1e-6);
    test::expect_certified(one_layer(box.shell, box.split), PrismTest::twelve_tets);
}

TEST(ScaleThickness, KeepsGrownShellsCertified)
{
    for (const GrowOptions& options : test::ways_to_grow())
        for (const TriangleMesh& mesh :
             {test::trefoil(120, 10), test::bumpy_sphere(),
              test::translated(test::torus(1.0, 0.3, 24, 12), Vec3d(3000, -2000, 1000))}) {
            const GrowResult grown = test::grown(mesh, options);
            for (const double factor : {0.9, 0.5, 0.05}) {
                PrismShell shell = grown.shell;
                scaled(shell, grown.split, factor, prism_test_of(options));
                test::expect_certified(one_layer(shell, grown.split), prism_test_of(options));
            }
        }
}

// The theorem: with twelve positive tets any factor is valid. Rounding has the last word, but far
// above the size of a float it says nothing.
TEST(ScaleThickness, ShortensNothingWhereTheTheoremHolds)
{
    SplitShell made = test::scaled_shell(icosphere(1, 3), 0.2f);
    for (const double factor : {0.9, 0.5, 0.1})
        EXPECT_EQ(scaled(made.shell, made.split, factor, PrismTest::twelve_tets).shortened, 0U);
}

TEST(ScaleThickness, FactorOneChangesNoBit)
{
    GrowResult grown = test::grown(test::bumpy_sphere());
    const PrismShell before = grown.shell;
    const ScaleReport report =
        scale_thickness(grown.shell, grown.split, by(1.0), PrismTest::twelve_tets);
    EXPECT_EQ(report.shortened + report.pinned, 0U);
    EXPECT_EQ(grown.shell.inner, before.inner);
    EXPECT_EQ(grown.shell.outer, before.outer);
    EXPECT_EQ(grown.shell.stop, before.stop);
}

TEST(ScaleThickness, PinsStayPins)
{
    SplitShell made = test::pinned_shell();
    EXPECT_EQ(scaled(made.shell, made.split, 0.5, PrismTest::twelve_tets).pinned, 0U);
    EXPECT_EQ(std::count(made.shell.stop.begin(), made.shell.stop.end(), StopReason::pinned), 0);
    test::expect_certified(one_layer(made.shell, made.split), PrismTest::twelve_tets);
}

// A half of a float is none.
TEST(ScaleThickness, PinsWhatRoundingLeavesWithoutLength)
{
    SplitShell made = test::one_float_shell();
    const ScaleReport report = scaled(made.shell, made.split, 0.25, PrismTest::twelve_tets);
    EXPECT_EQ(report.pinned, 8U);
    EXPECT_EQ(made.shell.inner, made.shell.outer);
}

/// Every pillar at the given share of its length, with nothing tested.
PrismShell scaled_blindly(PrismShell shell, double factor)
{
    for (std::size_t v = 0; v < shell.outer.size(); ++v) {
        const Vec3d a(shell.outer[v]), b(shell.inner[v]);
        shell.inner[v] = Vec3s(a + factor * (b - a));
    }
    return shell;
}

/// Whether the chosen tets hold at full length and not at the share.
bool spoiled_by_scaling(const SplitShell& made, double factor)
{
    return certify_shell(made.shell, made.split, PrismTest::chosen_tets).certified() &&
           !certify_shell(scaled_blindly(made.shell, factor), made.split, PrismTest::chosen_tets)
                .certified();
}

/// A sphere whose points lie at random distances from its middle, the nearest at a ninth of the
/// farthest.
TriangleMesh spiky_sphere(unsigned seed)
{
    std::mt19937 random(seed);
    TriangleMesh mesh = icosphere(1, 1);
    for (Vec3s& p : mesh.points)
        p *= static_cast<float>(0.2 + 1.6 * (double(random()) / double(std::mt19937::max())));
    return mesh;
}

// In a convex solid every inner point sees the triangles above from behind, and nothing is spoiled.
TEST(ScaleThickness, MendsWhatScalingSpoilsWithTheChosenTetsAlone)
{
    std::size_t spoiled = 0;
    for (unsigned seed = 0; seed <= 12; ++seed) {
        const GrowResult grown = test::grown(spiky_sphere(seed), test::ways_to_grow()[1]);
        for (const double factor : {0.9, 0.5}) {
            SplitShell made{grown.shell, grown.split};
            const bool bad = spoiled_by_scaling(made, factor);
            spoiled += bad;
            const ScaleReport report =
                scaled(made.shell, made.split, factor, PrismTest::chosen_tets);
            if (bad) {
                EXPECT_GT(report.shortened, 0U) << "seed " << seed << ", " << factor;
            }
            test::expect_certified(one_layer(made.shell, made.split), PrismTest::chosen_tets);
        }
    }
    EXPECT_GT(spoiled, 0U) << "nothing was spoiled: the test tests nothing";
}

TEST(ScaleThickness, SameBitsForAnyNumberOfThreads)
{
    const GrowResult grown = test::grown(test::trefoil(90, 8), test::by_method(Method::thickest));
    const auto scaled_with = [&](std::size_t threads) {
        const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
        PrismShell shell = grown.shell;
        scale_thickness(shell, grown.split, by(0.7), PrismTest::chosen_tets);
        return shell.inner;
    };
    EXPECT_EQ(scaled_with(1), scaled_with(2));
}

TEST(ScaleThickness, RefusesBadFactorsByName)
{
    SplitShell made = test::scaled_shell(icosphere(1, 1), 0.5f);
    const auto scale = [&](double factor) {
        scale_thickness(made.shell, made.split, by(factor), PrismTest::twelve_tets);
    };
    test::expect_positive_finite("thickness scale: factor", scale);
    EXPECT_EQ(test::refusal_of([&] { scale(1.0001); }),
              "thickness scale: factor is 1.0001, must be above 0 and at most 1");
}

TEST(ScaleThickness, CanBeCancelled)
{
    SplitShell made = test::scaled_shell(icosphere(1, 1), 0.5f);
    test::expect_cancelled([&](Interrupter* interrupter) {
        scale_thickness(made.shell, made.split, by(0.5), PrismTest::twelve_tets, interrupter);
    });
}

} // namespace
