// SPDX-License-Identifier: Apache-2.0
#include "vdb_shell/field/level_set.h"

#include "support/shapes.h"
#include "vdb_shell/core/error.h"

#include <gmock/gmock-matchers.h>
#include <gtest/gtest.h>
#include <openvdb/tools/Interpolation.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>

namespace vdb_shell
{
namespace
{

using openvdb::Vec3d;
using ::testing::HasSubstr;

LevelSetOptions at_resolution(int resolution)
{
    LevelSetOptions options;
    options.resolution = resolution;
    return options;
}

template <typename Error> std::string message_of(const std::function<void()>& call)
{
    try {
        call();
    } catch (const Error& error) {
        return error.what();
    }
    return "nothing thrown";
}

struct StopsAfter : Interrupter {
    explicit StopsAfter(int polls) : left(polls) {}
    bool wasInterrupted(int) override { return --left < 0; }
    void start(const char*) override { ++open; }
    void end() override { --open; }
    int left, open = 0;
};

TEST(LevelSet, GivesSignedDistancesThroughTheWholeInside)
{
    const Vec3d low(-0.5, -0.3, -0.2), high(0.5, 0.3, 0.2);
    const auto grid = mesh_to_level_set(test::box(low, high), at_resolution(40));
    const double voxel = grid->voxelSize()[0];
    EXPECT_DOUBLE_EQ(voxel, 1.0 / 40);
    std::size_t inside = 0;
    for (auto value = grid->cbeginValueOn(); value; ++value) {
        const Vec3d p = grid->indexToWorld(value.getCoord());
        const Vec3d to_low = low - p, to_high = p - high;
        const Vec3d q = openvdb::math::maxComponent(to_low, to_high);
        const double depth = std::max({q[0], q[1], q[2]});
        if (depth >= 0)
            continue;
        ++inside;
        EXPECT_NEAR(*value, depth, 0.1 * voxel) << p;
    }
    // 39 x 23 x 15 voxel centres lie strictly inside.
    EXPECT_EQ(inside, 39u * 23u * 15u);
}

TEST(LevelSet, SaysWhatItIs)
{
    const auto grid = mesh_to_level_set(test::icosphere(1, 2), at_resolution(16));
    EXPECT_EQ(grid->getName(), "surface");
    EXPECT_EQ(grid->getGridClass(), openvdb::GRID_LEVEL_SET);
    EXPECT_TRUE(grid->isInWorldSpace());
    EXPECT_FLOAT_EQ(grid->background(), static_cast<float>(3 * grid->voxelSize()[0]));
    // Voxel centres at whole multiples of the voxel size.
    EXPECT_EQ(grid->indexToWorld(Vec3d(0.0)), Vec3d(0.0));
}

TEST(LevelSet, InteriorBandReachesTheDepthAskedForAndNotMuchDeeper)
{
    LevelSetOptions options = at_resolution(64);
    const TriangleMesh mesh = test::icosphere(1, 3);
    const double voxel = resolve_voxel_size(mesh, options);
    options.interior_depth = 8 * voxel;
    const auto grid = mesh_to_level_set(mesh, options);
    double deepest = 0;
    for (auto value = grid->cbeginValueOn(); value; ++value)
        deepest = std::min(deepest, static_cast<double>(*value));
    EXPECT_LE(deepest, -10 * voxel);
    EXPECT_GE(deepest, -12 * voxel);
}

TEST(LevelSet, KeepsItsAccuracyFarFromTheOrigin)
{
    // 100 diagonals away: float32 leaves 3e-3 voxels.
    const TriangleMesh mesh = test::translated(test::icosphere(1, 4), Vec3d(350, -350, 350));
    const auto grid = mesh_to_level_set(mesh, at_resolution(32));
    const double voxel = grid->voxelSize()[0];
    std::size_t looked_at = 0;
    for (auto value = grid->cbeginValueOn(); value; ++value) {
        const double r = (grid->indexToWorld(value.getCoord()) - Vec3d(350, -350, 350)).length();
        if (r < 0.2)
            continue;
        EXPECT_NEAR(*value, r - 1, 0.1 * voxel);
        ++looked_at;
    }
    // 32 voxels across, the ball without its middle has 17,000 of them.
    EXPECT_GT(looked_at, 15000u);
}

TEST(LevelSet, SameBitsForAnyNumberOfThreads)
{
    const TriangleMesh mesh = test::torus(1, 0.4, 40, 20);
    const auto made_by = [&](std::size_t threads) {
        const tbb::global_control control(tbb::global_control::max_allowed_parallelism, threads);
        return mesh_to_level_set(mesh, at_resolution(48));
    };
    const auto one = made_by(1);
    for (const std::size_t threads : {2, 7}) {
        const auto other = made_by(threads);
        ASSERT_TRUE(one->tree().hasSameTopology(other->tree()));
        // Inactive voxels and tiles too.
        auto theirs = other->cbeginValueAll();
        for (auto value = one->cbeginValueAll(); value; ++value, ++theirs) {
            ASSERT_TRUE(theirs);
            const float ours = *value, other_one = *theirs;
            ASSERT_EQ(std::memcmp(&ours, &other_one, sizeof(float)), 0);
        }
    }
}

TEST(LevelSet, EstimateIsNotBelowTheGridAndGrowsAsTheVoxelsShrink)
{
    const TriangleMesh mesh = test::icosphere(1, 3);
    const LevelSetOptions options = at_resolution(64);
    const double voxel = resolve_voxel_size(mesh, options);
    const auto grid = mesh_to_level_set(mesh, options);
    const double estimate = estimate_level_set_bytes(mesh, voxel, options);
    EXPECT_GT(estimate, static_cast<double>(grid->memUsage()));
    EXPECT_GT(estimate_level_set_bytes(mesh, voxel / 32, options), 8000 * estimate / 32);
}

TEST(LevelSet, EstimateKnowsThatADeepBandAroundASmallObjectIsABall)
{
    LevelSetOptions options = at_resolution(8);
    const TriangleMesh mesh = test::unit_tetrahedron();
    const double voxel = resolve_voxel_size(mesh, options);
    for (const double depth : {1.0, 4.0}) {
        options.exterior_depth = depth;
        EXPECT_GT(estimate_level_set_bytes(mesh, voxel, options),
                  static_cast<double>(mesh_to_level_set(mesh, options)->memUsage()));
    }
    // A ball of 8,000 voxels across has 2.7e11 of them.
    options.exterior_depth = 500;
    EXPECT_GT(estimate_level_set_bytes(mesh, voxel, options), 1e12);
    options.max_memory_gib = 100;
    EXPECT_THAT(message_of<GeometryError>([&] { mesh_to_level_set(mesh, options); }),
                AllOf(HasSubstr("over the limit of 100 GiB"),
                      HasSubstr("voxels outside (--exterior-depth, --thickness)")));
}

TEST(LevelSet, RefusesWhatCannotFitInMemoryBeforeItTries)
{
    LevelSetOptions options;
    options.voxel_size = 2e-5;
    const TriangleMesh mesh = test::icosphere(1, 2);
    EXPECT_THAT(message_of<GeometryError>([&] { mesh_to_level_set(mesh, options); }),
                HasSubstr("over the limit of"));
    options.voxel_size = 0.05;
    options.max_memory_gib = 1e-3;
    EXPECT_THAT(message_of<GeometryError>([&] { mesh_to_level_set(mesh, options); }),
                HasSubstr("over the limit of 0.001 GiB"));
}

TEST(LevelSet, RefusesVoxelsThatDoNotFitTheObject)
{
    LevelSetOptions options;
    const TriangleMesh mesh = test::box(Vec3d(0.0), Vec3d(1.0));
    options.voxel_size = 1.5;
    const auto make = [&] { mesh_to_level_set(mesh, options); };
    EXPECT_THAT(message_of<GeometryError>(make),
                HasSubstr("voxel larger than the object: voxel size 1.5, longest side 1"));
    options.voxel_size = 1e-6;
    EXPECT_THAT(message_of<GeometryError>(make), HasSubstr("voxel size 1e-06 is below"));

    options.voxel_size = 0.01;
    const TriangleMesh far = test::translated(mesh, Vec3d(1e6, 0, 0));
    EXPECT_THAT(message_of<GeometryError>([&] { mesh_to_level_set(far, options); }),
                HasSubstr("too small for coordinates up to"));
}

TEST(LevelSet, OfAPlateBetweenVoxelCentresHasDistancesAndNoInside)
{
    LevelSetOptions options;
    options.voxel_size = 0.1;
    const auto thin = mesh_to_level_set(test::box(Vec3d(0, 0, 0.01), Vec3d(1, 1, 0.09)), options);
    EXPECT_FALSE(has_inside(*thin));
    // The centre below the plate's middle, and the one above.
    EXPECT_NEAR(thin->tree().getValue({5, 5, 0}), 0.01, 1e-6);
    EXPECT_NEAR(thin->tree().getValue({5, 5, 1}), 0.01, 1e-6);
    const auto thick = mesh_to_level_set(test::box(Vec3d(0, 0, -0.01), Vec3d(1, 1, 0.09)), options);
    EXPECT_TRUE(has_inside(*thick));
}

TEST(LevelSet, RefusesOptionsOutOfRange)
{
    const TriangleMesh mesh = test::box(Vec3d(0.0), Vec3d(1.0));
    const auto refused = [&](const std::function<void(LevelSetOptions&)>& change) {
        LevelSetOptions options;
        change(options);
        return message_of<InvalidOption>([&] { mesh_to_level_set(mesh, options); });
    };
    EXPECT_THAT(refused([](auto& o) { o.voxel_size = -0.1; }), HasSubstr("voxel_size is -0.1"));
    EXPECT_THAT(refused([](auto& o) { o.voxel_size = NAN; }), HasSubstr("voxel_size is nan"));
    EXPECT_THAT(refused([](auto& o) { o.resolution = 0; }), HasSubstr("resolution is 0"));
    EXPECT_THAT(refused([](auto& o) { o.exterior_voxels = 1; }), HasSubstr("exterior_voxels is 1"));
    EXPECT_THAT(refused([](auto& o) { o.interior_depth = 0; }), HasSubstr("interior_depth is 0"));
    EXPECT_THAT(refused([](auto& o) { o.max_memory_gib = -2; }), HasSubstr("max_memory_gib is -2"));
    EXPECT_THAT(message_of<GeometryError>([] { mesh_to_level_set({}, {}); }),
                HasSubstr("0 points and 0 triangles"));
}

TEST(LevelSet, StopsWhenItIsAskedTo)
{
    const TriangleMesh mesh = test::icosphere(1, 3);
    for (const int polls : {0, 1, 20}) {
        StopsAfter interrupter(polls);
        EXPECT_THROW(mesh_to_level_set(mesh, at_resolution(64), &interrupter), Cancelled);
        EXPECT_EQ(interrupter.open, 0);
    }
}

/// phi on the x axis at x, by the grid's trilinear interpolation.
double on_axis(const openvdb::FloatGrid& grid, double x)
{
    using Sampler = openvdb::tools::GridSampler<openvdb::FloatGrid, openvdb::tools::BoxSampler>;
    return Sampler(grid).wsSample(Vec3d(x, 0, 0));
}

TEST(LevelSet, SeesTheWallOfACavity)
{
    const TriangleMesh hollow =
        test::joined(test::icosphere(1.0, 4), test::reversed(test::icosphere(0.5, 4)));
    const auto grid = mesh_to_level_set(hollow, at_resolution(64));
    const double voxel = grid->voxelSize()[0];
    EXPECT_GT(on_axis(*grid, 0.0), 0.0);
    EXPECT_NEAR(on_axis(*grid, 0.5), 0.0, 0.2 * voxel);
    EXPECT_NEAR(on_axis(*grid, 0.6), -0.1, 0.2 * voxel);
    EXPECT_NEAR(on_axis(*grid, 0.9), -0.1, 0.2 * voxel);
}

TEST(LevelSet, ShallowBandsMeetNowhereButKeepTheirSigns)
{
    LevelSetOptions options = at_resolution(64);
    options.interior_depth = 0.05;
    const TriangleMesh hollow =
        test::joined(test::icosphere(1.0, 4), test::reversed(test::icosphere(0.5, 4)));
    const auto grid = mesh_to_level_set(hollow, options);
    const double voxel = grid->voxelSize()[0];
    EXPECT_GT(on_axis(*grid, 0.0), 0.0);
    EXPECT_NEAR(on_axis(*grid, 0.55), -0.05, 0.2 * voxel);
    EXPECT_LT(on_axis(*grid, 0.75), -0.05);
}

TEST(LevelSet, SeesASolidInsideACavity)
{
    const TriangleMesh nested =
        test::joined(test::joined(test::icosphere(1.0, 4), test::reversed(test::icosphere(0.6, 4))),
                     test::icosphere(0.3, 3));
    const auto grid = mesh_to_level_set(nested, at_resolution(64));
    EXPECT_LT(on_axis(*grid, 0.0), -0.2);
    EXPECT_GT(on_axis(*grid, 0.45), 0.0);
    EXPECT_LT(on_axis(*grid, 0.8), -0.1);
}

TEST(LevelSet, BodiesThatCrossAreOneSolidWhicheverPointIsFirst)
{
    // Of either box one corner lies in the other.
    TriangleMesh low = test::box({0, 0, 0}, {2, 2, 2}), high = test::box({1, 1, 1}, {3, 3, 3});
    const auto inside = [](const TriangleMesh& mesh, const Vec3d& point) {
        const auto grid = mesh_to_level_set(mesh, at_resolution(24));
        return openvdb::tools::BoxSampler::sample(grid->tree(), grid->worldToIndex(point)) < 0;
    };
    for (int turn = 0; turn < 2; ++turn) {
        const TriangleMesh both = test::joined(low, high);
        EXPECT_TRUE(inside(both, Vec3d(0.5))) << turn;
        EXPECT_TRUE(inside(both, Vec3d(1.5))) << turn;
        EXPECT_TRUE(inside(both, Vec3d(2.5))) << turn;
        EXPECT_FALSE(inside(both, Vec3d(2.5, 2.5, 0.5))) << turn;
        // The corner within the other box becomes the first point, by which nesting would go.
        const auto first = [](TriangleMesh& mesh, std::uint32_t point) {
            std::swap(mesh.points[0], mesh.points[point]);
            for (openvdb::Vec3I& t : mesh.triangles)
                for (int k = 0; k < 3; ++k)
                    t[k] = t[k] == 0 ? point : t[k] == point ? 0 : t[k];
        };
        const auto at = [](const TriangleMesh& mesh, const openvdb::Vec3s& p) {
            return std::uint32_t(std::find(mesh.points.begin(), mesh.points.end(), p) -
                                 mesh.points.begin());
        };
        first(low, at(low, {2, 2, 2}));
        first(high, at(high, {1, 1, 1}));
    }
}

TEST(LevelSet, TwoBodiesInOnePlaceAreASolid)
{
    const TriangleMesh ball = test::icosphere(1.0, 2);
    const auto grid = mesh_to_level_set(test::joined(ball, ball), at_resolution(24));
    EXPECT_LT(on_axis(*grid, 0.0), 0.0);
}

TEST(NegateLevelSet, GivesExactlyTheNegative)
{
    LevelSetOptions options;
    options.resolution = 24;
    options.exterior_depth = 0.5;
    const TriangleMesh ball = test::icosphere(1, 2);
    const auto level_set = mesh_to_level_set(ball, options);
    const double voxel = level_set->voxelSize()[0];
    EXPECT_GE(level_set->background(), 0.5 + 2.9 * voxel);
    const openvdb::FloatGrid::Ptr copy = level_set->deepCopy();
    negate_level_set(*copy);
    EXPECT_EQ(copy->background(), -level_set->background());
    auto original = level_set->getConstAccessor(), negated = copy->getConstAccessor();
    for (int i = -30; i <= 30; ++i) {
        const openvdb::Coord at(i, i / 2, -i / 3);
        EXPECT_EQ(negated.getValue(at), -original.getValue(at));
        EXPECT_EQ(negated.isValueOn(at), original.isValueOn(at));
    }
    negate_level_set(*copy);
    EXPECT_EQ(copy->background(), level_set->background());
    EXPECT_TRUE(copy->tree().hasSameTopology(level_set->tree()));
    for (auto value = level_set->cbeginValueAll(); value; ++value)
        EXPECT_EQ(copy->getConstAccessor().getValue(value.getCoord()), *value);
}

} // namespace
} // namespace vdb_shell
