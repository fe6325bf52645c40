// SPDX-License-Identifier: Apache-2.0
#include "vdb_shell/layers/cut_layers.h"

#include "support/broken_shells.h"
#include "support/stacks.h"
#include "vdb_shell/shell/sides.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

namespace
{

using namespace vdb_shell;
using openvdb::Vec3d;
using openvdb::Vec3s;
using test::icosphere;
using test::SplitShell;

LayerOptions layers(int count, double grading = 1)
{
    LayerOptions options;
    options.layers = count;
    options.grading = grading;
    return options;
}

ShellStack stack_of(const SplitShell& made)
{
    return one_layer(made.shell, made.split);
}

ShellStack stack_of(const GrowResult& result)
{
    return one_layer(result.shell, result.split);
}

/// Six times the volume: on whole numbers an exact sum.
double six_volumes(const PrismShell& layer, const PrismSplit& split)
{
    double sum = 0;
    const TetMesh tets = make_tets(layer, split);
    for (const openvdb::Vec4I& t : tets.tets) {
        const Vec3d a(tets.points[t[0]]);
        sum += (Vec3d(tets.points[t[1]]) - a)
                   .cross(Vec3d(tets.points[t[2]]) - a)
                   .dot(Vec3d(tets.points[t[3]]) - a);
    }
    return sum;
}

/// The given surfaces are those of the stack that was cut, and everything hangs together.
void expect_cut_of(const ShellStack& whole, const LayerResult& cut, std::size_t count)
{
    ASSERT_EQ(cut.stack.layers.size(), count * whole.layers.size());
    ASSERT_EQ(cut.stack.splits.size(), cut.stack.layers.size());
    EXPECT_EQ(cut.stack.skin, count * whole.skin);
    test::expect_joined(cut.stack);
    for (std::size_t k = 0; k < whole.surfaces(); ++k)
        EXPECT_EQ(cut.stack.surface(count * k), whole.surface(k));
    for (std::size_t k = 0; k < cut.stack.layers.size(); ++k) {
        EXPECT_EQ(cut.stack.layers[k].triangles, whole.triangles());
        EXPECT_EQ(cut.stack.splits[k].order, whole.splits[k / count].order);
    }
    double sum = 0;
    for (std::size_t k = 0; k < cut.stack.layers.size(); ++k)
        sum += tet_volume(make_tets(cut.stack.layers[k], cut.stack.splits[k]));
    const double volume = tet_volume(make_tets(whole));
    EXPECT_NEAR(sum, volume, 1e-12 * std::abs(volume));
    EXPECT_NEAR(tet_volume(make_tets(cut.stack)), volume, 1e-12 * std::abs(volume));
}

// Corners at 8, cuts at 6 and at 2: every coordinate and every determinant is a whole number.
TEST(CutLayers, VolumesInABoxAddUpExactly)
{
    const SplitShell box = test::scaled_shell(test::box(Vec3d(-8), Vec3d(8)), 0.25f);
    const LayerResult cut = cut_layers(stack_of(box), layers(2, 2), PrismTest::twelve_tets);
    expect_cut_of(stack_of(box), cut, 2);
    EXPECT_EQ(cut.report.moved, 0U);
    EXPECT_EQ(cut.report.uncut, 0U);
    for (const Vec3s& p : cut.stack.surface(1))
        for (int k = 0; k < 3; ++k)
            EXPECT_EQ(std::abs(p[k]), 6);
    const double outer = six_volumes(cut.stack.layers[0], cut.stack.splits[0]);
    const double inner = six_volumes(cut.stack.layers[1], cut.stack.splits[1]);
    EXPECT_EQ(outer, 6 * (16 * 16 * 16 - 12 * 12 * 12));
    EXPECT_EQ(inner, 6 * (12 * 12 * 12 - 4 * 4 * 4));
    EXPECT_EQ(outer + inner, six_volumes(box.shell, box.split));
}

TEST(CutLayers, GradingIsTheRatioOfNeighbouringPieces)
{
    const TriangleMesh torus = test::torus(1, 0.3, 24, 12);
    const SplitShell made =
        test::with_split(test::torus_shell(torus, 1, [](std::size_t) { return 0.2; }));
    for (const double grading : {0.5, 1.0, 2.0, 3.0}) {
        const LayerResult cut =
            cut_layers(stack_of(made), layers(4, grading), PrismTest::twelve_tets);
        expect_cut_of(stack_of(made), cut, 4);
        test::expect_certified(cut.stack, PrismTest::twelve_tets);
        EXPECT_EQ(cut.report.uncut, 0U);
        for (std::size_t v = 0; v < torus.points.size(); ++v) {
            double sum = 0;
            for (std::size_t k = 0; k < 4; ++k) {
                const double length = cut.stack.layers[k].length(v);
                sum += length;
                if (k > 0) {
                    EXPECT_NEAR(length, grading * cut.stack.layers[k - 1].length(v), 1e-6);
                }
            }
            EXPECT_NEAR(sum, made.shell.length(v), 1e-6);
        }
    }
}

TEST(CutLayers, CountsFromTheSkinOnBothSides)
{
    const TriangleMesh ball = icosphere(1, 2);
    const SplitShell inside = test::scaled_shell(ball, 0.5f);
    SplitShell around = test::scaled_shell(ball, 1.5f);
    std::swap(around.shell.outer, around.shell.inner);
    ShellStack outside = stack_of(around);
    outside.skin = 1;
    const ShellStack both = join_sides(outside, stack_of(inside));
    test::expect_certified(both, PrismTest::twelve_tets);
    const LayerResult cut = cut_layers(both, layers(2, 3), PrismTest::twelve_tets);
    expect_cut_of(both, cut, 2);
    test::expect_certified(cut.stack, PrismTest::twelve_tets);
    EXPECT_EQ(cut.stack.skin, 2U);
    EXPECT_EQ(cut.stack.surface(2), ball.points);
    const std::array<double, 5> radii{1.5, 1.125, 1, 0.875, 0.5};
    for (std::size_t k = 0; k < 5; ++k)
        for (const Vec3s& p : cut.stack.surface(k))
            EXPECT_NEAR(Vec3d(p).length(), radii[k], 1e-6);
    const LayerResult above = cut_layers(outside, layers(2, 3), PrismTest::twelve_tets);
    EXPECT_EQ(above.stack.layers[0].inner, cut.stack.layers[0].inner);
    EXPECT_EQ(above.stack.skin, 2U);
}

// Cuts at shares below 2^-24 fall on the skin: layers without a tet, which are counted.
TEST(CutLayers, LayersThinnerThanFloatsAreCountedAsEmpty)
{
    const SplitShell ball = test::scaled_shell(icosphere(1, 0), 0.5f);
    const LayerResult cut = cut_layers(stack_of(ball), layers(64, 2), PrismTest::twelve_tets);
    expect_cut_of(stack_of(ball), cut, 64);
    std::size_t empty = 0;
    for (std::size_t k = 0; k < cut.stack.layers.size(); ++k)
        empty += make_tets(cut.stack.layers[k], cut.stack.splits[k]).tets.empty();
    EXPECT_EQ(cut.report.empty, empty);
    EXPECT_GT(empty, 30U);
    EXPECT_EQ(cut_layers(stack_of(ball), layers(8, 2), PrismTest::twelve_tets).report.empty, 0U);
}

TEST(CutLayers, OneLayerChangesNoBit)
{
    const ShellStack whole = stack_of(test::folded_shell());
    const LayerResult cut = cut_layers(whole, layers(1, 7), PrismTest::twelve_tets);
    expect_cut_of(whole, cut, 1);
    EXPECT_EQ(cut.report.moved + cut.report.uncut, 0U);
}

TEST(CutLayers, PinsStayPinsInEveryLayer)
{
    const SplitShell made = test::pinned_shell();
    const LayerResult cut = cut_layers(stack_of(made), layers(3, 2), PrismTest::twelve_tets);
    expect_cut_of(stack_of(made), cut, 3);
    test::expect_certified(cut.stack, PrismTest::twelve_tets);
    EXPECT_EQ(cut.report.uncut, 0U);
    for (const PrismShell& layer : cut.stack.layers)
        for (std::size_t v = 0; v < layer.outer.size(); ++v)
            EXPECT_EQ(layer.pinned(v), v % 5 == 0) << v;
}

TEST(CutLayers, GrownShellsStayCertified)
{
    for (const GrowOptions& options : test::ways_to_grow())
        for (const TriangleMesh& mesh : {test::bumpy_sphere(), test::trefoil(120, 10)}) {
            const ShellStack whole = stack_of(test::grown(mesh, options));
            for (const double grading : {0.5, 1.0, 2.0}) {
                const LayerResult cut =
                    cut_layers(whole, layers(3, grading), prism_test_of(options));
                expect_cut_of(whole, cut, 3);
                test::expect_certified(cut.stack, prism_test_of(options));
                EXPECT_LT(cut.report.uncut, mesh.points.size() / 10);
            }
        }
}

/// Points that differ from the shares of their pillars by more than rounding to the nearest float.
std::size_t moved_points(const ShellStack& whole, const ShellStack& cut,
                         const std::vector<double>& shares)
{
    std::size_t moved = 0;
    for (std::size_t j = 1; j <= shares.size(); ++j)
        for (std::size_t v = 0; v < whole.surface(0).size(); ++v) {
            const Vec3d a(whole.surface(0)[v]), b(whole.surface(1)[v]);
            moved += cut.surface(j)[v] != Vec3s(a + shares[j - 1] * (b - a));
        }
    return moved;
}

// Shells of a few floats' thickness, where rounding moves a cut by as much as a layer is thick.
TEST(CutLayers, StaysCertifiedWhereRoundingIsAsLargeAsALayer)
{
    std::size_t moved = 0, uncut = 0;
    for (const double far : {1e4, 1e5}) {
        const TriangleMesh ball = test::translated(test::bumpy_sphere(), Vec3d(far, -far, far));
        const GrowResult result = test::grown(ball);
        const ShellStack whole = stack_of(result);
        test::expect_certified(whole, PrismTest::twelve_tets);
        const LayerResult cut = cut_layers(whole, layers(4), PrismTest::twelve_tets);
        expect_cut_of(whole, cut, 4);
        test::expect_certified(cut.stack, PrismTest::twelve_tets);
        EXPECT_EQ(cut.report.moved, moved_points(whole, cut.stack, {0.25, 0.5, 0.75}));
        moved += cut.report.moved;
        std::size_t whole_pillars = 0;
        for (std::size_t v = 0; v < ball.points.size(); ++v)
            whole_pillars += !whole.layers[0].pinned(v) && cut.stack.layers[0].pinned(v) &&
                             cut.stack.layers[1].pinned(v) && cut.stack.layers[2].pinned(v);
        EXPECT_LE(cut.report.uncut, whole_pillars);
        uncut += cut.report.uncut;
    }
    EXPECT_GT(moved, 0U) << "nothing was spoiled: the test tests nothing";
    RecordProperty("uncut", int(uncut));
}

// Nothing fits between two neighbouring floats.
TEST(CutLayers, APillarOfOneFloatStaysOne)
{
    const SplitShell made = test::one_float_shell();
    const LayerResult cut = cut_layers(stack_of(made), layers(3), PrismTest::twelve_tets);
    expect_cut_of(stack_of(made), cut, 3);
    test::expect_certified(cut.stack, PrismTest::twelve_tets);
    for (std::size_t k = 1; k < 3; ++k)
        for (std::size_t v = 0; v < 8; ++v)
            for (int axis = 0; axis < 3; ++axis) {
                const float cut_at = cut.stack.surface(k)[v][axis];
                EXPECT_TRUE(cut_at == made.shell.outer[v][axis] ||
                            cut_at == made.shell.inner[v][axis]);
            }
}

// No theorem helps there: what cutting spoils is mended, or stays whole.
TEST(CutLayers, StaysCertifiedWithTheChosenTetsAlone)
{
    std::size_t shells = 0, mended = 0;
    for (unsigned seed = 0; seed < 400; ++seed) {
        const ShellStack whole = stack_of(test::scattered_shell(seed));
        if (!certify_stack(whole, PrismTest::chosen_tets).certified() ||
            certify_stack(whole, PrismTest::twelve_tets).certified())
            continue;
        ++shells;
        const LayerResult cut = cut_layers(whole, layers(3), PrismTest::chosen_tets);
        expect_cut_of(whole, cut, 3);
        test::expect_certified(cut.stack, PrismTest::chosen_tets);
        mended += cut.report.moved > 0;
    }
    EXPECT_GT(shells, 0U);
    EXPECT_GT(mended, 0U) << "nothing was spoiled: the test tests nothing";
}

TEST(CutLayers, TakesTheMostLayersAndTheSteepestGradings)
{
    const SplitShell made = test::scaled_shell(icosphere(1, 1), 0.5f);
    for (const double grading : {1e-300, 1e-3, 1.0, 1e3, 1e300}) {
        const int most = int(ShellStack::kMostLayers);
        const LayerResult cut =
            cut_layers(stack_of(made), layers(most, grading), PrismTest::twelve_tets);
        expect_cut_of(stack_of(made), cut, ShellStack::kMostLayers);
        for (std::size_t k = 0; k <= ShellStack::kMostLayers; ++k)
            for (const Vec3s& p : cut.stack.surface(k))
                ASSERT_TRUE(std::isfinite(p[0]) && std::isfinite(p[1]) && std::isfinite(p[2]));
        test::expect_certified(cut.stack, PrismTest::twelve_tets);
    }
}

// A prism that failed keeps its failure, and the stage ends.
TEST(CutLayers, DoesNotHideAFailure)
{
    const SplitShell made = test::inside_out_shell();
    const LayerResult cut = cut_layers(stack_of(made), layers(3), PrismTest::twelve_tets);
    test::expect_joined(cut.stack);
    EXPECT_EQ(cut.stack.surface(3), made.shell.inner);
    EXPECT_FALSE(certify_stack(cut.stack, PrismTest::twelve_tets).certified());
}

TEST(CutLayers, SameBitsForAnyNumberOfThreads)
{
    const ShellStack whole = stack_of(test::grown(
        test::translated(test::trefoil(90, 8), Vec3d(3e4)), test::by_method(Method::thickest)));
    const auto cut_with = [&](std::size_t threads) {
        const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
        return cut_layers(whole, layers(5, 1.5), PrismTest::chosen_tets);
    };
    const LayerResult one = cut_with(1), two = cut_with(2);
    for (std::size_t k = 0; k < 6; ++k)
        EXPECT_EQ(one.stack.surface(k), two.stack.surface(k));
    EXPECT_EQ(one.report.moved, two.report.moved);
    EXPECT_EQ(one.report.uncut, two.report.uncut);
}

TEST(CutLayers, RefusesBadOptionsByName)
{
    const ShellStack whole = stack_of(test::scaled_shell(icosphere(1, 1), 0.5f));
    const auto refusal = [&](const ShellStack& stack, const LayerOptions& options) {
        return test::refusal_of([&] { cut_layers(stack, options, PrismTest::twelve_tets); });
    };
    for (const int count : {-1, -3, 251})
        EXPECT_EQ(refusal(whole, layers(count)),
                  "layers: layers is " + std::to_string(count) + ", must be 0 to 250");
    test::expect_positive_finite("layers: grading", [&](double grading) {
        cut_layers(whole, layers(2, grading), PrismTest::twelve_tets);
    });
    const ShellStack two = cut_layers(whole, layers(2), PrismTest::twelve_tets).stack;
    EXPECT_EQ(refusal(two, layers(126)), "layers: 252 in all, must be at most 250");
    EXPECT_EQ(refusal(two, layers(125)), "accepted");
}

TEST(CutLayers, CanBeCancelled)
{
    const ShellStack whole = stack_of(test::scaled_shell(icosphere(1, 1), 0.5f));
    test::expect_cancelled([&](Interrupter* interrupter) {
        cut_layers(whole, layers(2), PrismTest::twelve_tets, interrupter);
    });
}

} // namespace
