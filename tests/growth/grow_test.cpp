// SPDX-License-Identifier: Apache-2.0
#include "vdb_shell/growth/grow.h"

#include "growth/grown.h"
#include "growth/move_tests.h"
#include "growth/predicates.h"
#include "growth/sound.h"
#include "mesh/curve_order.h"
#include "support/shapes.h"
#include "support/stacks.h"
#include "vdb_shell/certify/certificate.h"
#include "vdb_shell/certify/conformity.h"
#include "vdb_shell/certify/coverage.h"
#include "vdb_shell/core/error.h"
#include "vdb_shell/mesh/check_mesh.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numeric>

namespace
{

using namespace vdb_shell;
using openvdb::Vec3d;
using openvdb::Vec3s;
using test::bumpy_sphere;
using test::Case;
using test::case_of;
using test::expect_all_positive;
using test::expect_embedded;
using test::expect_sound;
using test::expect_twelve_positive;
using test::fill_of;
using test::grown;
using test::kInfinity;

std::size_t count_of(const PrismShell& shell, StopReason reason)
{
    return static_cast<std::size_t>(std::count(shell.stop.begin(), shell.stop.end(), reason));
}

// The inner surface of a convex or a round solid can collapse onto its centre, so nothing but
// float32 and the size of the last steps (2e-4 of the diagonal, or the 0.2 % at which growth
// is content) keeps the fill from 1.
TEST(Grow, FillsConvexAndRoundSolids)
{
    for (const GrowOptions& options : test::ways_to_grow()) {
        for (const TriangleMesh& mesh :
             {test::box(Vec3d(-1), Vec3d(1)), test::box(Vec3d(0), Vec3d(3, 1, 0.5)),
              test::icosphere(1.0, 2), test::torus(1.0, 0.3, 32, 16)}) {
            const GrowResult result = grown(case_of(mesh), options);
            expect_sound(result, options);
            expect_embedded(result.shell);
            EXPECT_GT(fill_of(result.shell), 0.997);
            EXPECT_EQ(count_of(result.shell, StopReason::pinned), 0U);
            EXPECT_EQ(count_of(result.shell, StopReason::thickness), 0U);
        }
    }
}

TEST(Grow, ThreeTetsLeaveMoreRoomThanTwelveWhereTrianglesAreFew)
{
    for (const TriangleMesh& mesh : {bumpy_sphere(2), test::trefoil(30, 5)}) {
        GrowOptions options;
        const double twelve = fill_of(grown(case_of(mesh), options).shell);
        options.prism_test = PrismTest::chosen_tets;
        EXPECT_GT(fill_of(grown(case_of(mesh), options).shell), twelve);
    }
}

TEST(Grow, ThickestIsThickerThanCertified)
{
    for (const TriangleMesh& mesh : {bumpy_sphere(), bumpy_sphere(4)}) {
        GrowOptions options;
        const double certified = fill_of(grown(case_of(mesh), options).shell);
        options.method = Method::thickest;
        const double thickest = fill_of(grown(case_of(mesh), options).shell);
        RecordProperty("certified", std::to_string(certified));
        // A solid filled to 0.998 gets no further round by either.
        EXPECT_GE(thickest, std::min(certified + 0.0015, 0.998));
    }
}

/// Beside needles twelve tets before three lead into a corner.
TEST(Grow, ThickestIsAsThickAsThreeTetsFromTheBeginning)
{
    for (const TriangleMesh& mesh : {test::notched_cube(), bumpy_sphere(2)}) {
        GrowOptions options;
        options.prism_test = PrismTest::chosen_tets;
        const double three = fill_of(grown(case_of(mesh), options).shell);
        const GrowOptions thickest = test::by_method(Method::thickest);
        const GrowResult most = grown(case_of(mesh), thickest);
        // Rounds end at .998, for whoever has come that far.
        EXPECT_GE(fill_of(most.shell), std::min(three - 1e-6, 0.998));
        expect_sound(most, thickest);
        expect_embedded(most.shell);
    }
}

TEST(Grow, KeepsEveryStateValidWithoutSymmetry)
{
    const Case c = case_of(bumpy_sphere());
    const GrowResult certified = grown(c);
    expect_sound(certified);
    expect_embedded(certified.shell);
    EXPECT_GT(fill_of(certified.shell), 0.95);
    const GrowOptions thickest = test::by_method(Method::thickest);
    const GrowResult more = grown(c, thickest);
    expect_sound(more, thickest);
    expect_embedded(more.shell);
    EXPECT_GT(fill_of(more.shell), 0.95);
}

TEST(Grow, IsValidWithEveryLeverOff)
{
    const Case c = case_of(bumpy_sphere());
    for (bool GrowOptions::*lever :
         {&GrowOptions::mend_directions, &GrowOptions::smooth_directions, &GrowOptions::top_down,
          &GrowOptions::grow_lines, &GrowOptions::free_moves, &GrowOptions::soft_contacts,
          &GrowOptions::flips}) {
        GrowOptions options;
        options.*lever = false;
        options.free_rounds = 4;
        const GrowResult result = grown(c, options);
        expect_sound(result, options);
        expect_embedded(result.shell);
    }
}

TEST(Grow, FreeMovesWinWhereLinesAreStuck)
{
    const Case c = case_of(bumpy_sphere());
    GrowOptions lines_only;
    lines_only.free_moves = false;
    const GrowResult lines = grown(c, lines_only), free = grown(c);
    EXPECT_EQ(lines.report.rounds, 0U);
    EXPECT_NEAR(fill_of(lines.shell), lines.report.fill_after_lines, 1e-12);
    // Free moves do not wait for lines that are far from done.
    EXPECT_LE(free.report.fill_after_lines, lines.report.fill_after_lines);
    EXPECT_GT(fill_of(free.shell), fill_of(lines.shell) + 0.01);
}

/// Exact for these coordinates: differences of float32 have at most 25 bits, their squares 50.
bool longer_than(const PrismShell& shell, std::size_t v, double length)
{
    long double squared = 0;
    for (int axis = 0; axis < 3; ++axis) {
        const long double extent =
            static_cast<long double>(shell.inner[v][axis]) - shell.outer[v][axis];
        squared += extent * extent;
    }
    return squared > static_cast<long double>(length) * length;
}

TEST(Grow, GivesTheThicknessAskedForAlongFlatFaces)
{
    const TriangleMesh mesh = test::gridded_box(Vec3d(0), Vec3d(2), 4);
    GrowOptions straight;
    straight.smooth_directions = straight.free_moves = false;
    const PrismShell shell = grown(case_of(mesh, 0.25), straight).shell;
    std::size_t flat = 0;
    for (std::size_t v = 0; v < mesh.points.size(); ++v) {
        int on_faces = 0;
        for (int axis = 0; axis < 3; ++axis)
            on_faces += mesh.points[v][axis] == 0 || mesh.points[v][axis] == 2;
        if (on_faces > 1)
            continue;
        ++flat;
        EXPECT_EQ(shell.length(v), 0.25) << v;
        EXPECT_EQ(shell.stop[v], StopReason::thickness);
    }
    EXPECT_EQ(flat, 6U * 9U);
}

TEST(Grow, NeverExceedsTheThickness)
{
    for (const Vec3d& shift : {Vec3d(0), Vec3d(1000, -700, 300)})
        for (const GrowOptions& options : test::ways_to_grow()) {
            Case c = case_of(test::translated(bumpy_sphere(), shift), 0.1);
            for (std::size_t v = 0; v < c.cap.size(); v += 3)
                c.cap[v] = 0.05; // a painted thickness
            c.cap[5] = 0;
            const GrowResult result = grown(c, options);
            expect_sound(result, options);
            for (std::size_t v = 0; v < c.cap.size(); ++v) {
                EXPECT_FALSE(longer_than(result.shell, v, c.cap[v])) << v;
                EXPECT_LE(result.shell.length(v), c.cap[v]) << v;
            }
            EXPECT_TRUE(result.shell.pinned(5));
            EXPECT_GT(count_of(result.shell, StopReason::thickness), c.cap.size() / 2);
        }
}

TEST(Grow, PinsAVertexThatNoDirectionServes)
{
    const Case c = case_of(test::pyramid_over_u());
    ASSERT_TRUE(check_mesh(c.mesh).embedded());
    for (const GrowOptions& options : test::ways_to_grow()) {
        const GrowResult result = grown(c, options);
        expect_sound(result, options);
        EXPECT_TRUE(result.shell.pinned(8));
        EXPECT_EQ(result.shell.stop[8], StopReason::pinned);
        EXPECT_EQ(count_of(result.shell, StopReason::pinned), 1U);
        EXPECT_GT(fill_of(result.shell), 0.3);
    }
}

TEST(Grow, FillsTwoComponents)
{
    const TriangleMesh box = test::box(Vec3d(0), Vec3d(1));
    const GrowResult result =
        grown(case_of(test::joined(box, test::translated(box, Vec3d(1.001, 0, 0)))));
    expect_sound(result);
    expect_embedded(result.shell);
    EXPECT_GT(fill_of(result.shell), 0.997);
}

TEST(Grow, GrowsFromBothSidesOfACavity)
{
    // The start may not jump over a cavity that lies within one prism of the outer surface.
    for (const double half : {0.3, 0.02}) {
        const TriangleMesh solid =
            test::joined(test::box(Vec3d(-1), Vec3d(1)),
                         test::translated(test::reversed(test::box(Vec3d(-half), Vec3d(half))),
                                          Vec3d(0.25, 0.1, -0.5)));
        const GrowResult result = grown(case_of(solid));
        expect_sound(result);
        expect_embedded(result.shell);
        EXPECT_GT(fill_of(result.shell), 0.3);
        const TetMesh tets = make_tets(result.shell, result.split);
        CoverageOptions sampling;
        sampling.samples = 20000;
        const Coverage coverage = estimate_coverage(solid, tets, sampling);
        EXPECT_EQ(coverage.in_several, 0U);
        EXPECT_EQ(coverage.outside_covered, 0U);
    }
}

// A cavity with hardly a shell of its own, that no line of the outer box meets: the start would
// cover it with one prism, touching nothing.
TEST(Grow, DoesNotStartAcrossACavity)
{
    const TriangleMesh solid =
        test::joined(test::box(Vec3d(-1), Vec3d(1)),
                     test::translated(test::reversed(test::box(Vec3d(-0.02), Vec3d(0.02))),
                                      Vec3d(0.25, 0.1, -0.5)));
    Case c = case_of(solid);
    std::fill(c.cap.begin() + 8, c.cap.end(), 0.01);
    const GrowResult result = grown(c);
    expect_sound(result);
    expect_embedded(result.shell);
}

TEST(Grow, EndsOnASurfaceThatCrossesItself)
{
    const TriangleMesh box = test::box(Vec3d(0), Vec3d(1));
    const GrowResult result =
        grown(case_of(test::joined(box, test::translated(box, Vec3d(0.5, 0.4, 0.3)))));
    // Surfaces that cross are no shell's, but each prism is sound, and what does not cross grows.
    expect_twelve_positive(result.shell);
    EXPECT_TRUE(check_conformity(result.shell, make_tets(result.shell, result.split)).conforming());
    // The two corners whose faces do not meet the other box.
    EXPECT_EQ(count_of(result.shell, StopReason::pinned), 14U);
    EXPECT_GT(fill_of(result.shell), 0.4);
}

TEST(Grow, GivesTheSameBitsForAnyNumberOfThreads)
{
    const Case c = case_of(test::joined(
        bumpy_sphere(), test::translated(test::torus(1, 0.3, 24, 12), Vec3d(4, 0, 0))));
    GrowOptions options = test::by_method(Method::thickest);
    options.free_rounds = 10;
    const auto with_threads = [&](std::size_t threads) {
        const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
        return grown(c, options);
    };
    const GrowResult one = with_threads(1);
    for (const std::size_t threads : {2, 7}) {
        const GrowResult other = with_threads(threads);
        EXPECT_EQ(std::memcmp(one.shell.inner.data(), other.shell.inner.data(),
                              one.shell.inner.size() * sizeof(Vec3s)),
                  0);
        EXPECT_EQ(one.split.order, other.split.order);
        EXPECT_EQ(one.shell.stop, other.shell.stop);
        EXPECT_EQ(one.report.flips, other.report.flips);
    }
}

// Growth goes through a large surface along a curve, whatever order its file has.
TEST(Grow, AShellHasTheVerticesAndTrianglesOfItsMeshWhereTheyWere)
{
    TriangleMesh mesh = bumpy_sphere(6);
    ASSERT_GE(mesh.triangles.size(), kLeastToOrder);
    std::vector<std::uint32_t> mirrored(mesh.points.size());
    for (std::size_t v = 0; v < mirrored.size(); ++v)
        // Every other one from the end.
        mirrored[v] = static_cast<std::uint32_t>(v % 2 == 0 ? v : 2 * (mirrored.size() / 2) - v);
    std::vector<std::uint32_t> triangles(mesh.triangles.size());
    std::iota(triangles.rbegin(), triangles.rend(), 0U);
    mesh = in_order(mesh, {mirrored, triangles});
    ASSERT_FALSE(curve_order(mesh).own());
    const Case c = case_of(mesh);
    const SplitOptions by_index{SplitRule::vertex_index, 1};
    const GrowResult result =
        grow_shell(c.mesh, c.directions, c.start, c.cap, GrowOptions{}, by_index);
    EXPECT_EQ(result.shell.outer, mesh.points);
    EXPECT_EQ(result.shell.triangles, mesh.triangles);
    EXPECT_EQ(result.shell.stop.size(), mesh.points.size());
    // Rules see the mesh's own indices.
    EXPECT_EQ(result.split.order, split_prisms(result.shell, by_index).order);
    const auto certificate = certify_shell(result.shell, result.split, PrismTest::twelve_tets);
    EXPECT_TRUE(certificate.certified());
    EXPECT_GT(fill_of(result.shell), 0.97);
    // Bumps and centre are as they are, so each pillar goes inward.
    for (std::size_t v = 0; v < mesh.points.size(); ++v)
        ASSERT_LT(result.shell.inner[v].length(), result.shell.outer[v].length()) << v;
    // And the way back from the coarsest surface leads to vertices of the mesh.
    const std::vector<Coarsened> levels = coarse_levels(mesh, GrowOptions{});
    ASSERT_FALSE(levels.empty());
    const std::vector<std::uint32_t> first = vertices_of_coarsest(mesh, {levels.front()});
    EXPECT_TRUE(std::is_sorted(first.begin(), first.end()));
    for (std::size_t v = 0; v < levels.front().from.size(); ++v)
        ASSERT_EQ(levels.front().mesh.points[v], mesh.points[levels.front().from[v]]) << v;
}

TEST(Grow, EndsWhereThereIsEnough)
{
    const Case c = case_of(bumpy_sphere());
    for (GrowOptions options : test::ways_to_grow()) {
        const GrowResult all = grown(c, options);
        options.enough_fill = 0.8;
        const GrowResult enough = grown(c, options);
        EXPECT_GE(fill_of(enough.shell), 0.8);
        EXPECT_LT(fill_of(enough.shell), fill_of(all.shell));
        EXPECT_LT(enough.report.rounds, all.report.rounds);
        expect_sound(enough, options);
        expect_embedded(enough.shell);
    }
    GrowOptions along_lines;
    along_lines.free_moves = false;
    const double all = fill_of(grown(c, along_lines).shell);
    along_lines.enough_fill = 0.9 * all;
    const double enough = fill_of(grown(c, along_lines).shell);
    EXPECT_GE(enough, 0.9 * all);
    EXPECT_LT(enough, all);
}

TEST(Grow, RefusesToFillNothingOrMoreThanTheSolid)
{
    GrowOptions options;
    for (const double enough : {0.0, -0.5, 1.0001, std::nan("")}) {
        options.enough_fill = enough;
        EXPECT_THROW(grown(case_of(test::box(Vec3d(0), Vec3d(1))), options), InvalidOption)
            << enough;
    }
}

TEST(Grow, RefusesNegativeRounds)
{
    GrowOptions options;
    options.free_rounds = -3;
    try {
        grown(case_of(test::box(Vec3d(0), Vec3d(1))), options);
        FAIL();
    } catch (const InvalidOption& error) {
        EXPECT_NE(std::string(error.what()).find("free_rounds is -3"), std::string::npos);
    }
}

TEST(Grow, HonoursTheUsersSplitUnderTwelveTets)
{
    const Case c = case_of(bumpy_sphere());
    GrowOptions options;
    options.free_rounds = 2;
    const SplitOptions by_index{SplitRule::vertex_index, 1};
    const GrowResult result = grow_shell(c.mesh, c.directions, c.start, c.cap, options, by_index);
    EXPECT_EQ(result.split.order, split_prisms(result.shell, by_index).order);
    expect_all_positive(result.shell, result.split);
}

// What is tested exactly has to be what is stored. g++ 12 merges neighbouring conversions into
// vector code that keeps the double; this is the loop it did it in.
TEST(Grow, RoundsToFloat32ForGood)
{
    for (int i = 1; i < 1000; ++i) {
        const Vec3d start(0.1 * i, -0.7 * i, 1.0 / i), step(1.0 / 3, 1e-7 * i, -0.3);
        const Vec3d x = growth::rounded(start + 0.37 * step);
        for (int k = 0; k < 3; ++k) {
            std::uint64_t bits = 0;
            const double coordinate = x[k];
            std::memcpy(&bits, &coordinate, sizeof bits);
            EXPECT_EQ(bits & ((std::uint64_t(1) << 29) - 1), 0U) << "more than float32's 24 bits";
        }
    }
}

} // namespace
