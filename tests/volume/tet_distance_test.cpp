// SPDX-License-Identifier: Apache-2.0
#include "vdb_shell/volume/tet_distance.h"

#include "core/grid_instances.h"
#include "mesh/nearest_on_triangle.h"
#include "mesh/triangle_corners.h"
#include "support/shapes.h"
#include "support/stacks.h"
#include "support/tapered.h"
#include "vdb_shell/core/error.h"
#include "vdb_shell/layers/cut_layers.h"
#include "vdb_shell/shell/core_tets.h"
#include "vdb_shell/shell/shared_points.h"
#include "vdb_shell/shell/sides.h"
#include "write/hand_made.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>
#include <limits>
#include <vector>

namespace vdb_shell
{
namespace
{

using openvdb::Int32Grid;
using openvdb::Vec3d;

constexpr double kDistanceVoxel = 0.07;

ShellStack stack_of(const TriangleMesh& mesh, double scale = 0.4)
{
    const test::HandMade made = test::hand_made_shell(mesh, scale);
    return one_layer(made.shell, made.split);
}

/// Grown: pillars are slanted and end where there is no more room.
ShellStack grown_stack()
{
    GrowResult grown = test::grown(test::bumpy_sphere(2));
    return one_layer(grown.shell, grown.split);
}

const Int32Grid& triangles_of(const TetDistances& distances)
{
    return dynamic_cast<const Int32Grid&>(*distances.nearest);
}

double to_triangle(const TriangleMesh& mesh, std::size_t triangle, const Vec3d& place)
{
    return (nearest_on_triangle(triangle_corners(mesh, triangle), place).point - place).length();
}

/// Of all triangles the nearest, the first where several are as near.
std::pair<double, std::size_t> nearest(const TriangleMesh& mesh, const Vec3d& place)
{
    std::pair<double, std::size_t> best{std::numeric_limits<double>::infinity(), 0};
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
        if (const double d = to_triangle(mesh, t, place); d < best.first)
            best = {d, t};
    return best;
}

TriangleMesh skin_of(const ShellStack& stack)
{
    return {stack.surface(stack.skin), stack.triangles()};
}

void expect_exact(const ShellStack& stack, const TetMesh& tets, double voxel = kDistanceVoxel)
{
    const TetDistances found = tet_distances(stack, tets, {voxel});
    const Int32Grid::ConstAccessor triangle = triangles_of(found).getConstAccessor();
    const TriangleMesh skin = skin_of(stack);
    EXPECT_GT(found.distance->activeVoxelCount(), 500U);
    EXPECT_EQ(found.distance->activeVoxelCount(), found.nearest->activeVoxelCount());
    for (auto value = found.distance->cbeginValueOn(); value; ++value) {
        const auto [least, of] = nearest(skin, voxel * value.getCoord().asVec3d());
        ASSERT_EQ(std::abs(*value), float(least)) << value.getCoord();
        ASSERT_EQ(triangle.getValue(value.getCoord()), std::int32_t(of)) << value.getCoord();
    }
}

bool same_bits(const TetDistances& a, const TetDistances& b)
{
    if (!test::same_grid(*a.distance, *b.distance))
        return false;
    const Int32Grid &x = triangles_of(a), &y = triangles_of(b);
    const Int32Grid::ConstAccessor other = y.getConstAccessor();
    for (auto value = x.cbeginValueOn(); value; ++value)
        if (other.getValue(value.getCoord()) != *value)
            return false;
    return x.activeVoxelCount() == y.activeVoxelCount();
}

TEST(TetDistance, IsTheDistanceToTheNearestOfAllTriangles)
{
    for (const ShellStack& stack :
         {stack_of(test::icosphere(1.0, 2)), stack_of(test::gridded_box({0, 0, 0}, {2, 1, 1}, 3)),
          grown_stack()})
        expect_exact(stack, make_tets(stack));
}

TEST(TetDistance, IsExactFarFromTheOriginToo)
{
    const ShellStack stack = stack_of(test::translated(test::icosphere(1.0, 2), {500, -300, 200}));
    expect_exact(stack, make_tets(stack));
}

TEST(TetDistance, IsExactWithTrianglesOfManyLeaves)
{
    const ShellStack stack = stack_of(test::box({0, 0, 0}, {4, 2, 1}));
    expect_exact(stack, make_tets(stack), 0.04);
}

TEST(TetDistance, BoundsAreNeverBelowTheDistanceAndNearPrismsNeverAboveOwnPrism)
{
    const ShellStack stack = grown_stack();
    const TetMesh tets = make_tets(stack);
    const TriangleMesh skin = skin_of(stack);
    const TetDistances exact = tet_distances(stack, tets, {kDistanceVoxel});
    const TetDistances own =
        tet_distances(stack, tets, {kDistanceVoxel, TetDistanceMethod::own_prism});
    const TetDistances near =
        tet_distances(stack, tets, {kDistanceVoxel, TetDistanceMethod::near_prisms});
    const auto at_own = own.distance->getConstAccessor(),
               at_near = near.distance->getConstAccessor();
    const auto triangle = triangles_of(near).getConstAccessor();
    std::size_t too_far = 0;
    for (auto value = exact.distance->cbeginValueOn(); value; ++value) {
        const openvdb::Coord& at = value.getCoord();
        ASSERT_LE(at_near.getValue(at), *value) << at; // inside: more is less
        ASSERT_LE(at_own.getValue(at), at_near.getValue(at)) << at;
        ASSERT_EQ(-at_near.getValue(at), float(to_triangle(skin, std::size_t(triangle.getValue(at)),
                                                           kDistanceVoxel * at.asVec3d())));
        too_far += at_own.getValue(at) < *value;
    }
    // Otherwise there would be nothing to correct.
    EXPECT_GT(too_far, 0U);
}

TEST(TetDistance, IsNegativeBelowTheSkinAndPositiveAboveIt)
{
    const TriangleMesh surface = test::icosphere(1.0, 2);
    const ShellStack inside = stack_of(surface, 0.6);
    // The layer that is grown outward lies below the reversed surface.
    const test::HandMade made = test::hand_made_shell(reversed_surface(surface), 1.5);
    const ShellStack outside = turn_back(one_layer(made.shell, made.split));
    const ShellStack both = join_sides(outside, inside);
    for (const ShellStack& stack : {inside, outside, both}) {
        const TetMesh tets = make_tets(stack);
        expect_exact(stack, tets);
        const TetDistances found = tet_distances(stack, tets, {kDistanceVoxel});
        for (auto value = found.distance->cbeginValueOn(); value; ++value) {
            const double r = kDistanceVoxel * value.getCoord().asVec3d().length();
            // The surface lies between the sphere around its vertices and that within its faces.
            if (r > 1.0) {
                EXPECT_GT(*value, 0) << r;
            } else if (r < 0.96) {
                EXPECT_LT(*value, 0) << r;
            }
        }
    }
}

TEST(TetDistance, LayersDoNotChangeIt)
{
    const ShellStack one = grown_stack();
    const ShellStack three = cut_layers(one, {3}, PrismTest::twelve_tets).stack;
    ASSERT_EQ(three.layers.size(), 3U);
    expect_exact(three, make_tets(three));
}

TEST(TetDistance, IsExactWherePrismsHaveOneTetOrTwo)
{
    for (const ShellStack& stack : {test::coned(test::icosphere(1.0, 2), openvdb::Vec3s(0.1f)),
                                    test::pinched_rod(), test::layers_to_a_point()}) {
        const TetMesh tets = make_tets(stack);
        ASSERT_LT(tets.tets.size(), 3 * stack.layers.size() * stack.triangles().size());
        expect_exact(stack, tets);
    }
}

TEST(TetDistance, LeavesTheVoidAlone)
{
    const ShellStack stack = stack_of(test::icosphere(1.0, 3), 0.5);
    const TetDistances found = tet_distances(stack, make_tets(stack), {kDistanceVoxel});
    EXPECT_FALSE(found.distance->tree().isValueOn({0, 0, 0}));
    EXPECT_EQ(found.distance->tree().getValue({0, 0, 0}), 0);
    EXPECT_EQ(triangles_of(found).tree().getValue({0, 0, 0}), -1);
}

/// A fan of tets from the origin to the inner surface fills the shell of a sphere.
CoreTets fan_of(const ShellStack& stack, const TetMesh& tets)
{
    CoreTets core;
    core.points = {{0, 0, 0}};
    core.source_vertex = {CoreTets::kNoVertex};
    const auto middle = std::uint32_t(tets.points.size());
    const auto outer = std::uint32_t(stack.layers[0].outer.size());
    for (const openvdb::Vec3I& t : stack.triangles())
        core.tets.emplace_back(middle, outer + t[0], outer + t[1], outer + t[2]);
    return core;
}

TEST(TetDistance, IsExactInTetsOfACoreToo)
{
    const ShellStack stack = stack_of(test::icosphere(1.0, 2), 0.5);
    const TetMesh shell = make_tets(stack), all = joined_tets(shell, fan_of(stack, shell));
    expect_exact(stack, all);
    const TetDistances found = tet_distances(stack, all, {kDistanceVoxel});
    EXPECT_LT(found.distance->tree().getValue({0, 0, 0}), -0.9);
    const TetDistances bound =
        tet_distances(stack, all, {kDistanceVoxel, TetDistanceMethod::own_prism});
    const auto exact = found.distance->getConstAccessor();
    for (auto value = bound.distance->cbeginValueOn(); value; ++value)
        ASSERT_LE(*value, exact.getValue(value.getCoord()));
}

TEST(TetDistance, TheNextPoseHasTheBitsOfTheSurfaceAlone)
{
    const ShellStack stack = grown_stack();
    const TetMesh rest = make_tets(stack);
    const TetDistances before = tet_distances(stack, rest, {kDistanceVoxel});
    const auto pose = [](std::vector<openvdb::Vec3s>& points) {
        for (openvdb::Vec3s& p : points)
            p = openvdb::Vec3s(p[0] + 0.2f * p[1] * p[1], 1.1f * p[1], p[2] - 0.1f * p[0]);
    };
    ShellStack bent = stack;
    pose(bent.layers[0].outer);
    pose(bent.layers[0].inner);
    const TetMesh tets = make_tets(bent);
    const TetDistances alone = tet_distances(bent, tets, {kDistanceVoxel});
    const TetDistances next =
        next_tet_distances(bent, tets, rest, *before.nearest, {kDistanceVoxel});
    EXPECT_TRUE(same_bits(alone, next));
    // As a bound, what was nearest is nearer than the prisms.
    const auto error = [&](const TetDistances& bound) {
        double sum = 0;
        const auto exact = alone.distance->getConstAccessor();
        for (auto value = bound.distance->cbeginValueOn(); value; ++value) {
            EXPECT_LE(*value, exact.getValue(value.getCoord()));
            sum += exact.getValue(value.getCoord()) - *value;
        }
        return sum;
    };
    const TetDistanceOptions own{kDistanceVoxel, TetDistanceMethod::own_prism};
    EXPECT_LT(error(next_tet_distances(bent, tets, rest, *before.nearest, own)),
              error(tet_distances(bent, tets, own)));
}

TEST(TetDistance, HasTheSameBitsOnAnyNumberOfThreads)
{
    const ShellStack stack = grown_stack();
    const TetMesh tets = make_tets(stack);
    const auto on_threads = [&](std::size_t threads) {
        const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
        return tet_distances(stack, tets, {0.03});
    };
    EXPECT_TRUE(same_bits(on_threads(1), on_threads(4)));
}

TEST(TetDistance, RefusesWhatDoesNotFit)
{
    const ShellStack stack = stack_of(test::icosphere(1.0, 1));
    const TetMesh tets = make_tets(stack);
    for (const double voxel : {0.0, -1.0, double(NAN), 1e-12})
        EXPECT_THROW(tet_distances(stack, tets, {voxel}), InvalidOption);
    const TetDistances found = tet_distances(stack, tets, {kDistanceVoxel});
    TetMesh fewer = tets;
    fewer.tets.pop_back();
    EXPECT_THROW(next_tet_distances(stack, tets, fewer, *found.nearest, {kDistanceVoxel}),
                 InvalidOption);
    EXPECT_THROW(next_tet_distances(stack, tets, tets, *found.distance, {kDistanceVoxel}),
                 InvalidOption);
    const auto wrong = openvdb::Int32Grid::create(-1);
    wrong->tree().setValue({0, 0, 0}, 80);
    EXPECT_THROW(next_tet_distances(stack, tets, tets, *wrong, {kDistanceVoxel}), InvalidOption);
    TetMesh fewer_points = tets;
    fewer_points.points.pop_back();
    EXPECT_THROW(next_tet_distances(stack, tets, fewer_points, *found.nearest, {kDistanceVoxel}),
                 InvalidOption);
}

TEST(TetDistance, NumbersOfInactiveVoxelsOfTheLastPoseAreNotTaken)
{
    const ShellStack stack = stack_of(test::icosphere(1.0, 1));
    const TetMesh tets = make_tets(stack);
    const TetDistances found = tet_distances(stack, tets, {kDistanceVoxel});
    // Of a file from elsewhere: what is not active may have any number.
    const auto strange = openvdb::Int32Grid::create(1 << 30);
    strange->setTransform(found.nearest->transform().copy());
    strange->tree().setValueOff({0, 0, 0}, 1 << 29);
    EXPECT_TRUE(
        same_bits(found, next_tet_distances(stack, tets, tets, *strange, {kDistanceVoxel})));
}

TEST(TetDistance, CanBeCancelled)
{
    const ShellStack stack = stack_of(test::icosphere(1.0, 1));
    const TetMesh tets = make_tets(stack);
    const TetDistances last = tet_distances(stack, tets, {kDistanceVoxel});
    test::expect_cancelled([&](Interrupter* interrupter) {
        tet_distances(stack, tets, {kDistanceVoxel}, interrupter);
    });
    test::expect_cancelled([&](Interrupter* interrupter) {
        next_tet_distances(stack, tets, tets, *last.nearest, {kDistanceVoxel}, interrupter);
    });
}

} // namespace
} // namespace vdb_shell
