// SPDX-License-Identifier: Apache-2.0
#include "growth/prolongate.h"

#include "growth/grown.h"
#include "support/shapes.h"
#include "support/stacks.h"
#include "vdb_shell/shell/sides.h"

#include <tbb/global_control.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

namespace
{

using namespace vdb_shell;
using openvdb::Vec3d;
using openvdb::Vec3s;
using test::fill_of;

std::vector<growth::CoarsePoint> nearest(const TriangleMesh& mesh, const TriangleMesh& coarse)
{
    return growth::nearest_coarse_points(mesh, coarse, MultilevelSchedule{});
}

growth::Pillars prolonged(const TriangleMesh& coarse, const std::vector<Vec3d>& inner,
                          const TriangleMesh& fine, const Directions& lines,
                          int fair_passes = MultilevelSchedule().fair_passes,
                          double most = std::numeric_limits<double>::infinity())
{
    const std::vector<double> cap(fine.points.size(), most);
    MultilevelSchedule schedule;
    schedule.fair_passes = fair_passes;
    return growth::prolonged_pillars(coarse, inner, fine,
                                     growth::connect(fine.points.size(), fine.triangles), cap,
                                     nearest(fine, coarse), lines, schedule);
}

/// Lines to the origin, along which all is seen.
Directions lines_to_the_origin(const TriangleMesh& mesh)
{
    Directions lines;
    for (const Vec3s& p : mesh.points)
        lines.inward.push_back(-Vec3d(p).unit());
    lines.visibility.assign(mesh.points.size(), 1.0);
    return lines;
}

TEST(Prolongate, PillarsEndWhereThoseOfTheCoarseShellDo)
{
    // The coarse shell of a sphere ends at a third of its radius.
    const TriangleMesh coarse = test::icosphere(3.0, 2), fine = test::icosphere(3.0, 4);
    std::vector<Vec3d> inner;
    for (const Vec3s& p : coarse.points)
        inner.push_back(Vec3d(p) / 3.0);
    Directions lines;
    lines.inward.assign(fine.points.size(), Vec3d(0.0));
    lines.visibility.assign(fine.points.size(), 0.7);
    const growth::Pillars pillars = prolonged(coarse, inner, fine, lines);
    for (std::size_t v = 0; v < fine.points.size(); ++v) {
        const Vec3d end = Vec3d(fine.points[v]) + pillars.length[v] * pillars.lines.inward[v];
        // On a chord of the inner sphere, which lies up to 0.035 below its arc.
        EXPECT_LE(end.length(), 1.0 + 1e-6);
        EXPECT_GE(end.length(), 0.96);
        EXPECT_GT(end.unit().dot(Vec3d(fine.points[v]).unit()), 0.999);
        EXPECT_EQ(pillars.lines.visibility[v], 0.7);
    }
}

TEST(Prolongate, APillarThatWouldLeaveOnTheOuterSideGoesAlongTheLine)
{
    const TriangleMesh sphere = test::icosphere(1.0, 2);
    std::vector<Vec3d> outside;
    for (const Vec3s& p : sphere.points)
        outside.push_back(1.5 * Vec3d(p));
    const Directions lines = lines_to_the_origin(sphere);
    const growth::Pillars pillars = prolonged(sphere, outside, sphere, lines, 0);
    for (std::size_t v = 0; v < sphere.points.size(); ++v) {
        EXPECT_EQ(pillars.lines.inward[v], lines.inward[v]);
        EXPECT_NEAR(pillars.length[v], 0.5, 1e-6);
    }
}

TEST(Prolongate, AKinkBetweenCoarseTrianglesIsMadeFair)
{
    // One pillar is longer than all others.
    const TriangleMesh coarse = test::icosphere(1.0, 1), fine = test::icosphere(1.0, 4);
    std::vector<Vec3d> inner;
    for (std::size_t v = 0; v < coarse.points.size(); ++v)
        inner.push_back(Vec3d(coarse.points[v]) * (v == 0 ? 0.3 : 0.6));
    const Directions lines = lines_to_the_origin(fine);
    const auto tip = std::find(fine.points.begin(), fine.points.end(), coarse.points[0]);
    ASSERT_NE(tip, fine.points.end());
    const auto length = [&](int passes) {
        return prolonged(coarse, inner, fine, lines, passes)
            .length[std::size_t(tip - fine.points.begin())];
    };
    EXPECT_NEAR(length(0), 0.7, 1e-6);
    EXPECT_LT(length(1), 0.69);
    EXPECT_LT(length(3), length(1) - 0.005);
    EXPECT_GT(length(3), 0.6);
}

TEST(Prolongate, PillarsAsLongAsTheyMayBeStaySo)
{
    const TriangleMesh sphere = test::icosphere(1.0, 2);
    std::vector<Vec3d> inner;
    for (std::size_t v = 0; v < sphere.points.size(); ++v)
        inner.push_back(Vec3d(sphere.points[v]) * (v % 2 == 0 ? 0.6 : 0.8));
    const Directions lines = lines_to_the_origin(sphere);
    const std::vector<double> length = prolonged(sphere, inner, sphere, lines, 1, 0.4).length;
    for (std::size_t v = 0; v < length.size(); ++v)
        if (v % 2 == 0)
            EXPECT_NEAR(length[v], 0.4, 1e-6);
        else
            EXPECT_GT(length[v], 0.21);
}

TEST(Prolongate, InnerPointsAreFairWhateverTheOuterOnesAreLike)
{
    // The fine sphere is rough; the coarse one, whose shell ends at half of its radius, is not.
    const TriangleMesh coarse = test::icosphere(1.0, 2);
    TriangleMesh fine = test::icosphere(1.0, 4);
    for (std::size_t v = 0; v < fine.points.size(); ++v)
        fine.points[v] *= v % 2 == 0 ? 1.01F : 0.99F;
    std::vector<Vec3d> inner;
    for (const Vec3s& p : coarse.points)
        inner.push_back(0.5 * Vec3d(p));
    const Directions lines = lines_to_the_origin(fine);
    const growth::Pillars pillars = prolonged(coarse, inner, fine, lines);
    for (std::size_t v = 0; v < fine.points.size(); ++v) {
        const Vec3d end = Vec3d(fine.points[v]) + pillars.length[v] * pillars.lines.inward[v];
        // The chords of the coarse sphere are up to 0.035 of its radius below their arcs; a tenth
        // of the outer one's roughness is left at most.
        EXPECT_LT(end.length(), 0.5 + 0.001);
        EXPECT_GT(end.length(), 0.5 * (1 - 0.035) - 0.001);
    }
}

class GrownFromCoarse : public testing::TestWithParam<GrowOptions>
{
};

TEST_P(GrownFromCoarse, IsCertifiedAndAboutAsThickAndTheSameForAnyNumberOfThreads)
{
    GrowOptions options = GetParam();
    const TriangleMesh mesh = test::bumpy_sphere(4);
    options.coarse_from = 0;
    const GrowResult without = test::grown(mesh, options);
    options.coarse_from = mesh.triangles.size();
    const GrowResult with = test::grown(mesh, options);
    test::expect_certified(one_layer(with.shell, with.split), prism_test_of(options));
    EXPECT_NE(with.shell.inner, without.shell.inner);
    EXPECT_GT(fill_of(with.shell), fill_of(without.shell) - 0.01);
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, 1);
    const GrowResult alone = test::grown(mesh, options);
    EXPECT_EQ(alone.shell.inner, with.shell.inner);
    EXPECT_EQ(alone.split.order, with.split.order);
}

TEST(Prolongate, LosesLessWhereOnlyTheChosenTetsHaveToBePositive)
{
    const TriangleMesh mesh = test::bumpy_sphere(5);
    const auto empty_before_rounds = [&](PrismTest test) {
        GrowOptions options;
        options.prism_test = test;
        options.enough_fill = 0.9;
        return 1 - test::grown(mesh, options).report.fill_after_lines;
    };
    EXPECT_LT(empty_before_rounds(PrismTest::chosen_tets),
              empty_before_rounds(PrismTest::twelve_tets));
}

TEST(Prolongate, LevelsGoDownToAThousandTrianglesOrSoInEvenSteps)
{
    const TriangleMesh mesh = test::bumpy_sphere(5);
    const std::vector<Coarsened> levels = coarse_levels(mesh, GrowOptions{});
    ASSERT_GE(levels.size(), 2U);
    EXPECT_NEAR(double(levels.back().mesh.triangles.size()), 1200, 50);
    const double first_ratio =
        double(mesh.triangles.size()) / double(levels.front().mesh.triangles.size());
    EXPECT_LE(first_ratio, GrowthSchedule().multilevel.greatest_ratio + 0.2);
    for (std::size_t i = 1; i < levels.size(); ++i)
        EXPECT_NEAR(double(levels[i - 1].mesh.triangles.size()) /
                        double(levels[i].mesh.triangles.size()),
                    first_ratio, 0.2);
}

TEST(Prolongate, TheCoarsestSurfacesVerticesAreTheMeshs)
{
    const TriangleMesh mesh = test::bumpy_sphere(5);
    const std::vector<Coarsened> levels = coarse_levels(mesh, GrowOptions{});
    const std::vector<std::uint32_t> vertices = vertices_of_coarsest(mesh, levels);
    ASSERT_EQ(vertices.size(), levels.back().mesh.points.size());
    for (std::size_t v = 0; v < vertices.size(); ++v)
        EXPECT_EQ(mesh.points[vertices[v]], levels.back().mesh.points[v]);
    EXPECT_EQ(vertices_of_coarsest(mesh, {}).size(), mesh.points.size());
}

TEST(Prolongate, LevelsOfAThinWallDoNotCrossThemselves)
{
    // A hollow ball. The coarsest of an even sequence would be flatter than the wall is thick.
    const TriangleMesh mesh =
        test::joined(test::icosphere(1.0, 4), test::reversed(test::icosphere(0.98, 4)));
    const std::vector<Coarsened> levels = coarse_levels(mesh, GrowOptions{});
    EXPECT_FALSE(levels.empty());
    for (const Coarsened& level : levels)
        EXPECT_TRUE(level.embedded);
}

TEST(Prolongate, NoLevelsForFewTrianglesNorOutwardNorWithoutItsLevers)
{
    const TriangleMesh mesh = test::bumpy_sphere(5);
    GrowOptions options;
    options.coarse_from = mesh.triangles.size() + 1;
    EXPECT_TRUE(coarse_levels(mesh, options).empty());
    options.coarse_from = 0;
    EXPECT_TRUE(coarse_levels(mesh, options).empty());
    options = {};
    EXPECT_TRUE(coarse_levels(reversed_surface(mesh), options).empty());
    options.free_moves = false;
    EXPECT_TRUE(coarse_levels(mesh, options).empty());
    options = {};
    options.top_down = false;
    EXPECT_TRUE(coarse_levels(mesh, options).empty());
}

TEST(Prolongate, ReadsLengthsOfTheCoarsestVerticesAlone)
{
    const TriangleMesh mesh = test::bumpy_sphere(4);
    GrowOptions options;
    options.coarse_from = 500;
    const GrowStart start{GrowFrom::levels, {}, coarse_levels(mesh, options)};
    ASSERT_FALSE(start.levels.empty());
    Directions directions;
    for (const Vec3s& p : mesh.points)
        directions.inward.push_back(-Vec3d(p).unit());
    directions.visibility.assign(mesh.points.size(), 0.5);
    const std::vector<double> cap(mesh.points.size(), std::numeric_limits<double>::infinity());
    LineLengths all{std::vector<double>(mesh.points.size(), 0.4), {}, {}}, some = all;
    some.length.assign(mesh.points.size(), 0.0);
    for (const std::uint32_t v : vertices_of_coarsest(mesh, start.levels))
        some.length[v] = all.length[v];
    const auto grow = [&](const LineLengths& lengths) {
        return grow_shell_from(start, mesh, directions, lengths, cap, options, {}).shell.inner;
    };
    EXPECT_EQ(grow(some), grow(all));
    // Without levels growth makes its own.
    EXPECT_EQ(grow_shell(mesh, directions, all, cap, options, {}).shell.inner, grow(all));
}

TEST(Prolongate, IsThickerWhenRoundsAreAskedFor)
{
    // Without them it is less full than what ends rounds by itself.
    const TriangleMesh mesh = test::torus(2.0, 0.8, 48, 24);
    GrowOptions options;
    options.coarse_from = 500;
    const GrowResult brief = test::grown(mesh, options);
    options.free_rounds = 40;
    const GrowResult patient = test::grown(mesh, options);
    EXPECT_GT(fill_of(patient.shell), fill_of(brief.shell));
    options.free_rounds = 3;
    EXPECT_EQ(test::grown(mesh, options).report.rounds, 3U);
}

TEST_P(GrownFromCoarse, EndsWhereThereIsEnough)
{
    const TriangleMesh mesh = test::bumpy_sphere(4);
    GrowOptions options = GetParam();
    options.coarse_from = 500;
    const double by_itself = fill_of(test::grown(mesh, options).shell);
    double last = 0;
    for (const double enough : {0.85, 0.95, 0.99}) {
        options.enough_fill = enough;
        const GrowResult result = test::grown(mesh, options);
        const double fill = fill_of(result.shell);
        EXPECT_GE(fill, enough);
        EXPECT_GT(fill, last);
        last = fill;
        test::expect_certified(one_layer(result.shell, result.split), prism_test_of(options));
    }
    options.enough_fill = 0.85;
    EXPECT_LT(fill_of(test::grown(mesh, options).shell), by_itself);
}

TEST(Prolongate, GoesOnForAsMuchAsIsAskedFor)
{
    const TriangleMesh mesh = test::bumpy_sphere(4);
    GrowOptions options;
    options.coarse_from = 500;
    const GrowResult brief = test::grown(mesh, options);
    options.enough_fill = 1;
    const GrowResult more = test::grown(mesh, options);
    EXPECT_GT(fill_of(more.shell), fill_of(brief.shell));
    EXPECT_GT(more.report.rounds, brief.report.rounds);
}

TEST(Prolongate, IsMostlyDoneBeforeTheFirstRoundOnTheWhole)
{
    const TriangleMesh mesh = test::bumpy_sphere(6);
    ASSERT_GT(mesh.triangles.size(), 50000U);
    GrowOptions options;
    options.free_rounds = 0;
    const GrowResult result = test::grown(mesh, options);
    EXPECT_EQ(result.report.rounds, 0U);
    EXPECT_GT(fill_of(result.shell), 0.95);
    test::expect_certified(one_layer(result.shell, result.split), PrismTest::twelve_tets);
}

TEST_P(GrownFromCoarse, KeepsToTheCap)
{
    GrowOptions options = GetParam();
    options.coarse_from = 500;
    const GrowResult result = test::grown(test::torus(2.0, 0.8, 48, 24), options, 0.125);
    for (std::size_t v = 0; v < result.shell.inner.size(); ++v)
        EXPECT_LE(result.shell.length(v), 0.125) << v;
}

INSTANTIATE_TEST_SUITE_P(Each, GrownFromCoarse, testing::ValuesIn(test::ways_to_grow()));

} // namespace
