// SPDX-License-Identifier: Apache-2.0
#include "volume/tet_index_grid.h"

#include "core/counter_random.h"
#include "core/grid_instances.h"
#include "support/shapes.h"
#include "vdb_shell/write/vdb_file.h"
#include "write/hand_made.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
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

// Most lines of voxels pass beside such a tet, as they do beside those of fine surfaces.
TEST(TetIndexGrid, HasAllCentresInLongThinTetsAndNoOthers)
{
    const CounterRandom random(11);
    std::uint64_t drawn = 0;
    const auto within = [&](double size) {
        Vec3d at;
        for (int k = 0; k < 3; ++k)
            at[k] = size * (2 * random.unit(drawn++) - 1);
        return at;
    };
    std::size_t inside = 0;
    for (int needle = 0; needle < 200; ++needle) {
        // Along axes as well, where sides are parallel to lines and rows.
        Vec3d along = within(30);
        if (needle % 4 < 3)
            along = openvdb::Vec3d(0.0), along[needle % 4] = 25;
        const Vec3d start = within(3);
        TetMesh tet;
        for (const Vec3d& p :
             {start, start + within(1.2), start + along, start + along + within(1.2)})
            tet.points.emplace_back(p);
        tet.tets.emplace_back(0, 1, 2, 3);
        std::array<Vec3d, 4> corner;
        for (std::size_t i = 0; i < 4; ++i)
            corner[i] = Vec3d(tet.points[i]);
        const double whole = volume_of(corner);
        const auto grid = tet_index_grid(tet, 1.0, "test", StageProgress(nullptr, "test"));
        const openvdb::CoordBBox box(openvdb::Coord(-35), openvdb::Coord(35));
        for (auto at = box.begin(); at; ++at) {
            double least = 1;
            for (std::size_t i = 0; i < 4; ++i) {
                std::array<Vec3d, 4> part = corner;
                part[i] = (*at).asVec3d();
                least = std::min(least, volume_of(part) / whole);
            }
            if (least > 1e-8)
                ++inside;
            // On a face either answer is right.
            if (std::abs(least) > 1e-8) {
                ASSERT_EQ(grid->tree().isValueOn(*at), least > 0) << needle << " " << *at;
            }
        }
    }
    EXPECT_GT(inside, 400U);
}

} // namespace
} // namespace vdb_shell
