// SPDX-License-Identifier: Apache-2.0
#include "vdb_shell/field/smooth.h"

#include "core/grid_instances.h"
#include "support/shapes.h"
#include "vdb_shell/core/error.h"
#include "vdb_shell/field/level_set.h"

#include <gmock/gmock-matchers.h>
#include <gtest/gtest.h>

#include <cmath>

namespace vdb_shell
{
namespace
{

using openvdb::Vec3d;

struct Case {
    TriangleMesh mesh;
    openvdb::FloatGrid::Ptr grid;
    double voxel;
};

Case made(const TriangleMesh& mesh, int resolution)
{
    LevelSetOptions options;
    options.resolution = resolution;
    const auto grid = mesh_to_level_set(mesh, options);
    return {mesh, grid, grid->voxelSize()[0]};
}

TEST(Smooth, ZeroIterationsLeaveTheFieldAlone)
{
    const Case c = made(test::icosphere(1, 3), 32);
    const auto before = c.grid->deepCopy();
    const SmoothReport report = smooth_level_set(*c.grid, c.mesh, {0});
    for (auto value = before->cbeginValueAll(); value; ++value)
        ASSERT_EQ(*value, c.grid->tree().getValue(value.getCoord()));
    EXPECT_LT(report.max_drift, 0.1 * c.voxel);
}

TEST(Smooth, SphereShrinksByItsCurvatureAndStaysADistanceFieldToTheCentre)
{
    const Case c = made(test::icosphere(1, 4), 32);
    const int n = 20;
    const double radius = std::sqrt(1 - 2 * n * c.voxel * c.voxel / 3);
    ASSERT_GT(1 - radius, 0.4 * c.voxel);
    const SmoothReport report = smooth_level_set(*c.grid, c.mesh, {n});
    EXPECT_NEAR(report.mean_drift, 1 - radius, 0.1 * c.voxel);
    EXPECT_NEAR(report.max_drift, 1 - radius, 0.2 * c.voxel);
    std::size_t deep = 0;
    for (auto value = c.grid->cbeginValueOn(); value; ++value) {
        const double r = c.grid->indexToWorld(value.getCoord()).length();
        if (r >= radius)
            continue;
        EXPECT_NEAR(*value, r - radius, 0.3 * c.voxel) << value.getCoord();
        deep += r < 0.2;
    }
    EXPECT_GT(deep, 100u);
}

TEST(Smooth, RoundsTheCornersOfABoxAndKeepsItsDepth)
{
    const Case c = made(test::box(Vec3d(0.0), Vec3d(1, 0.8, 0.6)), 40);
    const SmoothReport report = smooth_level_set(*c.grid, c.mesh, {10});
    // All vertices are corners; a ball rolled into one touches no closer than this.
    EXPECT_GT(report.mean_drift, c.voxel);
    EXPECT_NEAR(report.max_drift, report.mean_drift, 0.2 * c.voxel);
    // Flat faces do not move, so neither does the depth under their middles.
    for (const double depth : {0.1, 0.2, 0.275}) {
        const auto ijk = openvdb::Coord::round(c.grid->worldToIndex(Vec3d(0.5, 0.4, 0.6 - depth)));
        const double z = c.grid->indexToWorld(ijk)[2];
        EXPECT_NEAR(c.grid->tree().getValue(ijk), z - 0.6, 0.1 * c.voxel) << depth;
        EXPECT_TRUE(c.grid->tree().isValueOn(ijk));
    }
}

TEST(Smooth, SaysWhenNothingIsLeft)
{
    const Case c = made(test::icosphere(1, 2), 6);
    EXPECT_THROW(smooth_level_set(*c.grid, c.mesh, {200}), GeometryError);
}

TEST(Smooth, RefusesNegativeIterationsAndFogVolumes)
{
    const Case c = made(test::icosphere(1, 2), 16);
    EXPECT_THROW(smooth_level_set(*c.grid, c.mesh, {-1}), InvalidOption);
    c.grid->setGridClass(openvdb::GRID_FOG_VOLUME);
    EXPECT_THROW(smooth_level_set(*c.grid, c.mesh, {1}), GeometryError);
}

struct StopsAtOnce : Interrupter {
    bool wasInterrupted(int percent) override { return percent != 0; }
};

TEST(Smooth, StopsWhenItIsAskedTo)
{
    const Case c = made(test::icosphere(1, 2), 16);
    StopsAtOnce interrupter;
    EXPECT_THROW(smooth_level_set(*c.grid, c.mesh, {5}, &interrupter), Cancelled);
}

} // namespace
} // namespace vdb_shell
