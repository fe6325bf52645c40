// SPDX-License-Identifier: Apache-2.0
#include "vdb_shell/volume/motion_volume.h"

#include "core/grid_instances.h"
#include "support/cancelled.h"
#include "volume/ball.h"

#include <gtest/gtest.h>

namespace vdb_shell
{
namespace
{

using openvdb::Vec3d;

constexpr double kMotionVoxel = 0.1;

openvdb::FloatGrid::Ptr fog_in_ball()
{
    auto fog = openvdb::FloatGrid::create();
    fog->setTransform(openvdb::math::Transform::createLinearTransform(kMotionVoxel));
    fog->fill(openvdb::CoordBBox(openvdb::Coord(-12, -3, 3), openvdb::Coord(-6, 3, 5)), 1.0f);
    fog->tree().voxelizeActiveTiles();
    return fog;
}

TEST(MotionVolume, HasTheShellsVelocityAtEachVoxel)
{
    openvdb::initialize();
    const test::Ball posed = test::ball(test::turned_long);
    const ShellMap velocity = test::velocity_of_turning(posed);
    const auto fog = fog_in_ball();
    const auto made = openvdb::gridPtrCast<openvdb::Vec3SGrid>(
        motion_volume(*fog, posed.map(), velocity, Vec3d(0.0)));
    EXPECT_EQ(made->getName(), "v");
    EXPECT_EQ(made->getVectorType(), openvdb::VEC_CONTRAVARIANT_RELATIVE);
    EXPECT_EQ(made->transform(), fog->transform());
    EXPECT_EQ(made->activeVoxelCount(), fog->activeVoxelCount());
    for (auto voxel = made->cbeginValueOn(); voxel; ++voxel) {
        ASSERT_TRUE(fog->tree().isValueOn(voxel.getCoord()));
        const Vec3d at = kMotionVoxel * voxel.getCoord().asVec3d();
        EXPECT_LT((Vec3d(*voxel) - test::turning(at)).length(), 1e-5);
    }
}

TEST(MotionVolume, CanBeCancelled)
{
    openvdb::initialize();
    const test::Ball posed = test::ball(test::turned_long);
    const ShellMap velocity = test::velocity_of_turning(posed), map = posed.map();
    const auto fog = fog_in_ball();
    test::expect_cancelled([&](Interrupter* interrupter) {
        motion_volume(*fog, map, velocity, Vec3d(0.0), interrupter);
    });
}

} // namespace
} // namespace vdb_shell
