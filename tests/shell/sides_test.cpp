// SPDX-License-Identifier: Apache-2.0
#include "vdb_shell/mesh/normals.h"
#include "vdb_shell/shell/sides.h"

#include "core/exact.h"
#include "core/grid_instances.h"
#include "support/broken_shells.h"
#include "support/stacks.h"
#include "vdb_shell/certify/certificate.h"
#include "vdb_shell/certify/conformity.h"
#include "vdb_shell/certify/coverage.h"
#include "vdb_shell/certify/stack_certificate.h"
#include "vdb_shell/certify/tet_signs.h"
#include "vdb_shell/growth/grow.h"
#include "vdb_shell/shell/tessellate.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>
#include <set>

namespace
{

using namespace vdb_shell;
using openvdb::Vec3d;
using openvdb::Vec3s;
using test::icosphere;
using test::SplitShell;

Directions normals_of(const TriangleMesh& mesh)
{
    return directions_along(mesh, pseudo_normals(mesh));
}

GrowResult grown(const TriangleMesh& mesh, const std::vector<double>& cap,
                 const GrowOptions& options)
{
    const std::size_t count = mesh.points.size();
    const LineLengths none{std::vector<double>(count, 0.0), std::vector<std::uint32_t>(count, 0),
                           std::vector<StopReason>(count, StopReason::none)};
    return grow_shell(mesh, normals_of(mesh), none, cap, options, {});
}

ShellStack stack_of(const GrowResult& result)
{
    return one_layer(result.shell, result.split);
}

ShellStack outward(const TriangleMesh& mesh, const std::vector<double>& cap,
                   const GrowOptions& options = {})
{
    return turn_back(stack_of(grown(reversed_surface(mesh), cap, options)));
}

ShellStack outward(const TriangleMesh& mesh, double cap, const GrowOptions& options = {})
{
    return outward(mesh, std::vector<double>(mesh.points.size(), cap), options);
}

GrowOptions lines_only()
{
    GrowOptions options;
    options.free_moves = options.smooth_directions = false;
    return options;
}

double volume(const ShellStack& stack, std::size_t layer = 0)
{
    return tet_volume(make_tets(stack.layers[layer], stack.splits[layer]));
}

void expect_certified(const ShellStack& stack, PrismTest test = PrismTest::twelve_tets)
{
    for (std::size_t k = 0; k < stack.layers.size(); ++k) {
        const PrismShell& layer = stack.layers[k];
        for (const std::string& failure : certify_shell(layer, stack.splits[k], test).failures())
            ADD_FAILURE() << "layer " << k << ": " << failure;
        const TetMesh tets = make_tets(layer, stack.splits[k]);
        const TetSigns signs = count_tet_signs(tets);
        EXPECT_EQ(signs.inverted.count + signs.flat.count, 0U);
        EXPECT_TRUE(check_conformity(layer, tets).conforming());
    }
}

/// The layer ends on the input, in the input's orientation, and lies outside of it.
void expect_around(const ShellStack& stack, const TriangleMesh& mesh)
{
    EXPECT_EQ(stack.skin, 1U);
    EXPECT_EQ(stack.layers[0].inner, mesh.points);
    EXPECT_EQ(stack.layers[0].triangles, mesh.triangles);
    const double enclosed = signed_volume(mesh.points, mesh.triangles);
    EXPECT_NEAR(volume(stack), signed_volume(stack.layers[0].outer, mesh.triangles) - enclosed,
                1e-9 * std::abs(enclosed));
}

/// A second opinion without any sign: points within the outermost surface, none in two tets.
void expect_no_overlap(const ShellStack& stack)
{
    CoverageOptions sampling;
    sampling.samples = 20000;
    const PrismShell& layer = stack.layers[0];
    const Coverage coverage = estimate_coverage({layer.outer, layer.triangles},
                                                make_tets(layer, stack.splits[0]), sampling);
    EXPECT_EQ(coverage.in_several, 0U);
    EXPECT_EQ(coverage.outside_covered, 0U);
    EXPECT_NEAR(coverage.covered_share, volume(stack) / signed_volume(layer.outer, layer.triangles),
                5 * coverage.standard_error + 1e-9);
}

/// Sign of each tet by the set of its points.
std::map<std::set<std::array<float, 3>>, int> signs_by_corners(const PrismShell& shell,
                                                               const PrismSplit& split)
{
    std::map<std::set<std::array<float, 3>>, int> signs;
    const TetMesh tets = make_tets(shell, split);
    for (const openvdb::Vec4I& t : tets.tets) {
        std::array<Vec3s, 4> p;
        std::set<std::array<float, 3>> corners;
        for (int i = 0; i < 4; ++i) {
            p[std::size_t(i)] = tets.points[t[i]];
            corners.insert({p[std::size_t(i)][0], p[std::size_t(i)][1], p[std::size_t(i)][2]});
        }
        signs[corners] = exact::orient3d(p[0], p[1], p[2], p[3]);
    }
    return signs;
}

void expect_same_tets(const SplitShell& made)
{
    ShellStack turned = turn_back(one_layer(made.shell, made.split));
    EXPECT_EQ(turned.skin, 1U);
    EXPECT_EQ(turned.layers[0].outer, made.shell.inner);
    EXPECT_EQ(turned.layers[0].inner, made.shell.outer);
    EXPECT_EQ(signs_by_corners(turned.layers[0], turned.splits[0]),
              signs_by_corners(made.shell, made.split));
    turned.skin = 0;
    const ShellStack again = turn_back(turned);
    EXPECT_EQ(again.layers[0].triangles, made.shell.triangles);
    EXPECT_EQ(again.splits[0].order, made.split.order);
}

// Twisted so far that some tets are inverted: their signs have to come through as well.
TEST(Sides, TurningBackKeepsEveryTetAndItsSign)
{
    for (const double radians : {0.2, 1.5})
        for (const SplitRule rule : {SplitRule::vertex_index, SplitRule::length_descending}) {
            SplitShell made = test::twisted_shell(radians);
            made.split = split_prisms(made.shell, {rule, 1});
            expect_same_tets(made);
        }
    EXPECT_GT(
        count_tet_signs(make_tets(test::twisted_shell(1.5).shell, test::twisted_shell(1.5).split))
            .inverted.count,
        0U);
    expect_same_tets(test::folded_shell()); // pins
}

TEST(Sides, TurningBackTurnsTheOrderOfLayersAbout)
{
    const PrismShell near = test::scaled_shell(test::reversed(icosphere(1, 1)), 1.5f).shell;
    PrismShell far = near;
    far.outer = near.inner;
    for (Vec3s& p : far.inner)
        p *= 2.0f;
    const PrismSplit split = split_prisms(near, {});
    const ShellStack turned = turn_back({{near, far}, {split, split}, 0});
    EXPECT_EQ(turned.skin, 2U);
    EXPECT_EQ(turned.surface(0), far.inner);
    EXPECT_EQ(turned.surface(1), near.inner);
    EXPECT_EQ(turned.surface(2), near.outer);
    EXPECT_EQ(turned.triangles(), icosphere(1, 1).triangles);
    expect_certified(turned);
}

TEST(Sides, SphereOutwardIsTheSphereAroundIt)
{
    const TriangleMesh ball = icosphere(1, 3);
    for (const double thickness : {0.05, 0.5, 3.0}) {
        const ShellStack lines = outward(ball, thickness, lines_only());
        expect_certified(lines);
        expect_around(lines, ball);
        const double enclosed = signed_volume(ball.points, ball.triangles);
        const double wanted = enclosed * (std::pow(1 + thickness, 3) - 1);
        EXPECT_NEAR(volume(lines), wanted, 2e-3 * wanted);
        for (std::size_t v = 0; v < ball.points.size(); ++v)
            EXPECT_NEAR(lines.layers[0].length(v), thickness, 1e-6 * (1 + thickness));
        for (const GrowOptions& options : test::ways_to_grow()) {
            const ShellStack free = outward(ball, thickness, options);
            expect_certified(free, prism_test_of(options));
            EXPECT_GE(volume(free), volume(lines) * (1 - 1e-3));
        }
    }
}

// Corners go along the cube's diagonals, as far as the thickness allows.
TEST(Sides, BoxOutwardIsABoxAroundIt)
{
    const TriangleMesh cube = test::box(Vec3d(-1), Vec3d(1));
    const ShellStack stack = outward(cube, 0.5, lines_only());
    expect_certified(stack);
    expect_around(stack, cube);
    EXPECT_NEAR(volume(stack), std::pow(2 + 2 * 0.5 / std::sqrt(3.0), 3) - 8, 1e-5);

    const TriangleMesh gridded = test::gridded_box(Vec3d(-1), Vec3d(1), 4);
    const ShellStack fine = outward(gridded, 0.25, lines_only());
    expect_certified(fine);
    expect_no_overlap(fine);
    std::size_t flat = 0;
    for (std::size_t v = 0; v < gridded.points.size(); ++v) {
        const Vec3s& p = gridded.points[v];
        const Vec3s arm = fine.layers[0].outer[v] - p;
        for (int k = 0; k < 3; ++k)
            if (std::abs(p[k]) == 1 && std::abs(p[(k + 1) % 3]) < 1 &&
                std::abs(p[(k + 2) % 3]) < 1) {
                EXPECT_EQ(arm[k], std::copysign(0.25f, p[k])) << v;
                ++flat;
            }
    }
    EXPECT_EQ(flat, 54U);
}

bool in_some_tet(const TetMesh& tets, const Vec3s& p)
{
    return std::any_of(tets.tets.begin(), tets.tets.end(), [&](const openvdb::Vec4I& t) {
        const Vec3s &a = tets.points[t[0]], &b = tets.points[t[1]], &c = tets.points[t[2]],
                    &d = tets.points[t[3]];
        return exact::orient3d(a, b, c, p) >= 0 && exact::orient3d(a, c, d, p) >= 0 &&
               exact::orient3d(a, d, b, p) >= 0 && exact::orient3d(b, d, c, p) >= 0;
    });
}

// The medial axis of the outside of a torus is the axis of its hole.
TEST(Sides, TorusOutwardFillsItsHole)
{
    const TriangleMesh torus = test::torus(1.0, 0.3, 32, 16);
    const ShellStack stack = outward(torus, 2.0);
    expect_certified(stack);
    expect_around(stack, torus);
    const TetMesh tets = make_tets(stack.layers[0], stack.splits[0]);
    std::size_t points = 0, covered = 0;
    for (double r : {0.1, 0.2, 0.4, 0.6})
        for (int turn = 0; turn < 25; ++turn, ++points)
            covered +=
                in_some_tet(tets, Vec3s(Vec3d(r * std::cos(turn), r * std::sin(turn), 0.01)));
    EXPECT_GE(covered, points * 95 / 100);
}

TEST(Sides, TwoSpheresShareTheGap)
{
    const TriangleMesh ball = icosphere(1, 2);
    for (const double gap : {0.2, 0.02}) {
        const TriangleMesh two = test::joined(ball, test::translated(ball, Vec3d(2 + gap, 0, 0)));
        const ShellStack stack = outward(two, 0.5);
        expect_certified(stack);
        expect_around(stack, two);
        expect_no_overlap(stack);
        // Alone each would get the sphere of radius 1.5; together they lose its caps beyond the
        // plane half-way.
        const double alone = volume(outward(ball, 0.5)), height = 0.5 - gap / 2;
        const double cap = M_PI * height * height * (1.5 - height / 3);
        EXPECT_LT(volume(stack), 2 * alone - cap);
        EXPECT_GT(volume(stack), 0.97 * 2 * (alone - cap));
    }
}

TEST(Sides, OutwardFromACavityGoesIntoIt)
{
    // A ball with a cavity, in which there is a smaller ball.
    const TriangleMesh mesh = test::joined(
        test::joined(icosphere(1, 2), test::reversed(icosphere(0.6, 2))), icosphere(0.3, 2));
    const ShellStack stack = outward(mesh, 0.4);
    expect_certified(stack);
    expect_around(stack, mesh);
    expect_no_overlap(stack);
    const TriangleMesh outer = icosphere(1, 2);
    const double ball = signed_volume(outer.points, outer.triangles);
    const double space = ball * (0.6 * 0.6 * 0.6 - 0.3 * 0.3 * 0.3);
    const double around = volume(outward(outer, 0.4));
    EXPECT_GT(volume(stack) - around, 0.85 * space);
    EXPECT_LE(volume(stack) - around, (1 + 1e-3) * space);
}

TEST(Sides, PinsStayPins)
{
    const TriangleMesh ball = icosphere(1, 1);
    std::vector<double> cap(ball.points.size(), 0.1);
    cap[5] = 0;
    const ShellStack stack = outward(ball, cap);
    expect_certified(stack);
    EXPECT_TRUE(stack.layers[0].pinned(5));
    EXPECT_EQ(stack.layers[0].stop[5], StopReason::pinned);
}

TEST(Sides, NeverExceedsTheThickness)
{
    const TriangleMesh torus = test::translated(test::torus(1.0, 0.3, 24, 12), Vec3d(100, -70, 30));
    std::vector<double> cap(torus.points.size(), 0.2);
    for (std::size_t v = 0; v < cap.size(); v += 3)
        cap[v] = 0.05; // a painted thickness
    for (const GrowOptions& options : test::ways_to_grow()) {
        const ShellStack stack = outward(torus, cap, options);
        expect_certified(stack, prism_test_of(options));
        const PrismShell& layer = stack.layers[0];
        for (std::size_t v = 0; v < cap.size(); ++v)
            EXPECT_FALSE(exact::longer_than(layer.inner[v], layer.outer[v], cap[v])) << v;
        EXPECT_GT(std::count(layer.stop.begin(), layer.stop.end(), StopReason::thickness),
                  std::ptrdiff_t(cap.size() / 2));
    }
}

TEST(Sides, BothSidesMeetInTheSurface)
{
    const TriangleMesh ball = icosphere(1, 3);
    const std::vector<double> cap(ball.points.size(), 0.25);
    const ShellStack inside = stack_of(grown(ball, cap, lines_only()));
    const ShellStack outside = outward(ball, cap, lines_only());
    const ShellStack both = join_sides(outside, inside);
    EXPECT_EQ(both.skin, 1U);
    EXPECT_EQ(both.surface(1), ball.points);
    EXPECT_EQ(both.layers[0].inner, both.layers[1].outer);
    expect_certified(both);
    const StackCertificate certificate = certify_stack(both, PrismTest::twelve_tets);
    EXPECT_EQ(certificate.failures(), std::vector<std::string>{});
    const double enclosed = signed_volume(ball.points, ball.triangles);
    const double wanted = enclosed * (std::pow(1.25, 3) - std::pow(0.75, 3));
    EXPECT_NEAR(tet_volume(make_tets(both)), wanted, 2e-3 * wanted);
}

TEST(Sides, BothSidesOfSeveralComponents)
{
    const TriangleMesh ball = icosphere(1, 2);
    const TriangleMesh mesh = test::joined(test::joined(ball, test::reversed(icosphere(0.6, 2))),
                                           test::translated(ball, Vec3d(2.1, 0, 0)));
    const std::vector<double> cap(mesh.points.size(), 0.3);
    const ShellStack both =
        join_sides(outward(mesh, cap), stack_of(grown(mesh, cap, GrowOptions{})));
    EXPECT_EQ(certify_stack(both, PrismTest::twelve_tets).failures(), std::vector<std::string>{});
    CoverageOptions sampling;
    sampling.samples = 20000;
    const Coverage coverage =
        estimate_coverage({both.surface(0), both.triangles()}, make_tets(both), sampling);
    EXPECT_EQ(coverage.in_several, 0U);
    EXPECT_EQ(coverage.outside_covered, 0U);
}

TEST(Sides, SameBitsForAnyNumberOfThreads)
{
    const TriangleMesh mesh = test::joined(
        icosphere(1, 2), test::translated(test::torus(1, 0.3, 24, 12), Vec3d(2.4, 0, 0)));
    GrowOptions options = test::by_method(Method::thickest);
    options.free_rounds = 10;
    const auto with_threads = [&](std::size_t threads) {
        const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
        return outward(mesh, 0.3, options);
    };
    const ShellStack one = with_threads(1);
    for (const std::size_t threads : {2, 7}) {
        const ShellStack other = with_threads(threads);
        EXPECT_EQ(std::memcmp(one.layers[0].outer.data(), other.layers[0].outer.data(),
                              one.layers[0].outer.size() * sizeof(Vec3s)),
                  0);
        EXPECT_EQ(one.splits[0].order, other.splits[0].order);
    }
}

TEST(Sides, DefaultThicknessIsAShareOfTheDiagonal)
{
    EXPECT_DOUBLE_EQ(default_outward_thickness(test::box(Vec3d(5), Vec3d(6, 7, 7))),
                     kOutwardShare * 3);
}

} // namespace
