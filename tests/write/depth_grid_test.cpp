// SPDX-License-Identifier: Apache-2.0
#include "vdb_shell/core/error.h"
#include "vdb_shell/write/vdb_file.h"

#include "support/shapes.h"
#include "write/hand_made.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>

namespace vdb_shell
{
namespace
{

using openvdb::Coord;
using openvdb::Vec3d;

/// The corner tet (0, x, y, z) of size `s`: depth 1 at its apex z, 0 at the others.
TetMesh corner_tet(float s)
{
    TetMesh mesh;
    mesh.points = {{0, 0, 0}, {s, 0, 0}, {0, s, 0}, {0, 0, s}};
    mesh.tets = {{0, 1, 2, 3}};
    mesh.prism = {0};
    mesh.source_vertex = {0, 1, 2, 2};
    mesh.layer = {0, 0, 0, 1};
    return mesh;
}

TEST(ShellDepthGrid, FillsExactlyTheCentresInsideATet)
{
    const auto grid = shell_depth_grid(corner_tet(10.0f), 1.0);
    std::size_t expected = 0;
    for (int x = 0; x <= 10; ++x)
        for (int y = 0; x + y <= 10; ++y)
            for (int z = 0; x + y + z <= 10; ++z) {
                ++expected;
                ASSERT_TRUE(grid->tree().isValueOn({x, y, z})) << x << ' ' << y << ' ' << z;
                EXPECT_NEAR(grid->tree().getValue({x, y, z}), z / 10.0, 1e-6);
            }
    EXPECT_EQ(grid->activeVoxelCount(), expected);
    EXPECT_EQ(grid->getName(), "depth");
    EXPECT_EQ(grid->getGridClass(), openvdb::GRID_FOG_VOLUME);
    EXPECT_EQ(grid->background(), 0.0f);
}

TEST(ShellDepthGrid, IgnoresOrientationAndSkipsFlatTets)
{
    TetMesh mesh = corner_tet(6.0f);
    const auto upright = shell_depth_grid(mesh, 0.7);
    std::swap(mesh.tets[0][0], mesh.tets[0][1]);
    EXPECT_EQ(shell_depth_grid(mesh, 0.7)->activeVoxelCount(), upright->activeVoxelCount());
    mesh.points[3] = {3, 3, 0};
    EXPECT_EQ(shell_depth_grid(mesh, 0.7)->activeVoxelCount(), 0u);
}

TEST(ShellDepthGrid, SmallestIndexWinsWhereTetsOverlap)
{
    TetMesh mesh = corner_tet(10.0f);
    // The same place again with the depth turned round.
    for (int i = 0; i < 4; ++i)
        mesh.points.push_back(mesh.points[std::size_t(i)]);
    mesh.layer = {0, 0, 0, 1, 1, 1, 1, 0};
    mesh.source_vertex = {0, 1, 2, 2, 0, 1, 2, 2};
    mesh.tets.push_back({4, 5, 6, 7});
    mesh.prism.push_back(0);
    EXPECT_NEAR(shell_depth_grid(mesh, 1.0)->tree().getValue({1, 1, 7}), 0.7, 1e-6);
    std::swap(mesh.tets[0], mesh.tets[1]);
    EXPECT_NEAR(shell_depth_grid(mesh, 1.0)->tree().getValue({1, 1, 7}), 0.3, 1e-6);
}

TEST(ShellDepthGrid, HasNoHolesBetweenTets)
{
    // A cube scaled to half about its centre, its faces on the voxel centres themselves.
    const auto made = test::hand_made_shell(test::gridded_box({-8, -8, -8}, {8, 8, 8}, 4), 0.5);
    const auto grid = shell_depth_grid(made.tets, 1.0);
    for (int x = -8; x <= 8; ++x)
        for (int y = -8; y <= 8; ++y)
            for (int z = -8; z <= 8; ++z) {
                const int far = std::max({std::abs(x), std::abs(y), std::abs(z)});
                ASSERT_EQ(grid->tree().isValueOn({x, y, z}), far >= 4) << x << ' ' << y << ' ' << z;
                if (far >= 4) {
                    EXPECT_NEAR(grid->tree().getValue({x, y, z}), (8 - far) / 4.0, 1e-5);
                }
            }
}

TEST(ShellDepthGrid, SameBitsForAnyNumberOfThreads)
{
    const auto made = test::hand_made_shell(test::icosphere(1.0, 3), 0.3);
    const auto with_threads = [&](std::size_t threads) {
        const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
        return shell_depth_grid(made.tets, 0.02);
    };
    const auto one = with_threads(1);
    EXPECT_TRUE(test::same_grid(*one, *with_threads(2)));
    EXPECT_TRUE(test::same_grid(*one, *with_threads(7)));
}

TEST(ShellDepthGrid, RefusesImpossibleVoxels)
{
    const TetMesh mesh = corner_tet(1.0f);
    for (const double voxel : {0.0, -1.0, std::nan(""), HUGE_VAL, 1e-12})
        EXPECT_THROW(shell_depth_grid(mesh, voxel), InvalidOption) << voxel;
}

class Stop : public Interrupter
{
public:
    bool wasInterrupted(int) override { return true; }
};

TEST(ShellDepthGrid, CanBeCancelled)
{
    Stop stop;
    EXPECT_THROW(shell_depth_grid(corner_tet(1.0f), 0.1, &stop), Cancelled);
}

} // namespace
} // namespace vdb_shell
