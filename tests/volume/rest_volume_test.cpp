// SPDX-License-Identifier: Apache-2.0
#include "vdb_shell/volume/rest_volume.h"

#include "core/grid_instances.h"
#include "support/shapes.h"
#include "vdb_shell/core/error.h"
#include "vdb_shell/write/vdb_file.h"
#include "write/hand_made.h"

#include <gtest/gtest.h>

#include <array>
#include <string>
#include <vector>

namespace vdb_shell
{
namespace
{

using openvdb::Vec3d;
using openvdb::Vec3s;

constexpr double kRestVoxel = 0.05;

TetMesh tets_of(const TriangleMesh& mesh)
{
    return test::hand_made_shell(mesh, 0.5).tets;
}

openvdb::Vec3SGrid::Ptr grid_of(const TetMesh& posed, const std::vector<Vec3s>& rest)
{
    return openvdb::gridPtrCast<openvdb::Vec3SGrid>(rest_volume(posed, rest, kRestVoxel));
}

TEST(RestVolume, AtRestEveryVoxelIsWhereItIs)
{
    const TetMesh tets = tets_of(test::icosphere(1.0, 2));
    const auto grid = grid_of(tets, tets.points);
    EXPECT_EQ(grid->getName(), "rest");
    EXPECT_EQ(grid->activeVoxelCount(), shell_depth_grid(tets, kRestVoxel)->activeVoxelCount());
    EXPECT_GT(grid->activeVoxelCount(), 10000U);
    for (auto voxel = grid->cbeginValueOn(); voxel; ++voxel)
        ASSERT_LT((Vec3d(*voxel) - grid->indexToWorld(voxel.getCoord())).length(), 1e-6);
}

TEST(RestVolume, ARefusalSaysWhichVolumeItIsOf)
{
    const TetMesh tets = tets_of(test::icosphere(1.0, 1));
    const auto message = [&](const auto& volume) -> std::string {
        try {
            volume(tets, tets.points, 0.0, nullptr);
        } catch (const InvalidOption& error) {
            return error.what();
        }
        return "";
    };
    EXPECT_EQ(message(rest_volume).rfind("rest volume: voxel size", 0), 0U);
    EXPECT_EQ(message(velocity_volume).rfind("velocity volume: voxel size", 0), 0U);
}

TEST(RestVolume, AMovedShellTellsWhereItWas)
{
    const auto pose = [](const TriangleMesh& mesh) {
        return test::translated(test::turned(mesh, {0, 0, 1}, 0.6), {2, 1, 0});
    };
    const TetMesh rest = tets_of(test::icosphere(1.0, 2));
    TetMesh posed = rest;
    posed.points = pose({rest.points, {}}).points;
    const auto grid = grid_of(posed, rest.points);
    ASSERT_GT(grid->activeVoxelCount(), 0U);
    double farthest = 0;
    for (auto voxel = grid->cbeginValueOn(); voxel; ++voxel) {
        const Vec3d back =
            test::turned({{Vec3s(grid->indexToWorld(voxel.getCoord()) - Vec3d(2, 1, 0))}, {}},
                         {0, 0, 1}, -0.6)
                .points[0];
        farthest = std::max(farthest, (Vec3d(*voxel) - back).length());
    }
    EXPECT_LT(farthest, 1e-5);
}

TEST(RestVolume, ImpossibleVoxelsAreRefused)
{
    const TetMesh tets = tets_of(test::icosphere(1.0, 1));
    for (const double voxel : {0.0, -1.0, 1e-12})
        EXPECT_THROW(rest_volume(tets, tets.points, voxel), InvalidOption);
}

} // namespace
} // namespace vdb_shell
