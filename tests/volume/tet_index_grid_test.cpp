// SPDX-License-Identifier: Apache-2.0
#include "volume/tet_index_grid.h"

#include "core/grid_instances.h"
#include "support/shapes.h"
#include "vdb_shell/write/vdb_file.h"
#include "write/hand_made.h"

#include <gtest/gtest.h>

#include <vector>

namespace vdb_shell
{
namespace
{

using openvdb::Vec3d;

constexpr double kTetVoxel = 0.05;

TetMesh shell_tets()
{
    return test::hand_made_shell(test::icosphere(1.0, 2), 0.5).tets;
}

/// Six times the volume of the tet.
double volume_of(const std::array<Vec3d, 4>& p)
{
    return (p[1] - p[0]).dot((p[2] - p[0]).cross(p[3] - p[0]));
}

TEST(TetIndexGrid, EveryVoxelLiesInTheTetThatItNames)
{
    const TetMesh tets = shell_tets();
    const auto grid = tet_index_grid(tets, kTetVoxel, "test", StageProgress(nullptr, "test"));
    EXPECT_EQ(grid->activeVoxelCount(), shell_depth_grid(tets, kTetVoxel)->activeVoxelCount());
    for (auto voxel = grid->cbeginValueOn(); voxel; ++voxel) {
        ASSERT_GE(*voxel, 0);
        const Vec3d centre = kTetVoxel * voxel.getCoord().asVec3d();
        std::array<Vec3d, 4> corner;
        for (int i = 0; i < 4; ++i)
            corner[std::size_t(i)] = Vec3d(tets.points[tets.tets[std::size_t(*voxel)][i]]);
        const double whole = volume_of(corner);
        for (std::size_t i = 0; i < 4; ++i) {
            std::array<Vec3d, 4> part = corner;
            part[i] = centre;
            EXPECT_GT(volume_of(part), -1e-6 * whole) << voxel.getCoord();
        }
    }
}

TEST(TetIndexGrid, LeavesOutWhatIsNotWanted)
{
    const TetMesh tets = shell_tets();
    std::vector<std::uint8_t> wanted(tets.tets.size(), 0);
    for (std::size_t t = 0; t < wanted.size(); t += 3)
        wanted[t] = 1;
    const StageProgress progress(nullptr, "test");
    const auto all = tet_index_grid(tets, kTetVoxel, "test", progress);
    const auto some = tet_index_grid(tets, kTetVoxel, "test", progress, wanted);
    EXPECT_GT(some->activeVoxelCount(), 0u);
    EXPECT_LT(some->activeVoxelCount(), all->activeVoxelCount());
    for (auto voxel = some->cbeginValueOn(); voxel; ++voxel)
        EXPECT_TRUE(wanted[std::size_t(*voxel)]) << voxel.getCoord();
}

} // namespace
} // namespace vdb_shell
