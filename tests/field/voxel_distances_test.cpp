// SPDX-License-Identifier: Apache-2.0
#include "field/voxel_distances.h"

#include "mesh/nearest_on_triangle.h"
#include "mesh/triangle_corners.h"

#include <gtest/gtest.h>
#include <openvdb/openvdb.h>

#include <algorithm>
#include <cstdint>

namespace
{

using namespace vdb_shell;
using openvdb::Vec3d;

constexpr double kBand = 3;

/// Sheets that lie askew, one above the other.
TriangleMesh sheets(int count, float apart)
{
    TriangleMesh mesh;
    for (int i = 0; i < count; ++i) {
        const float z = apart * static_cast<float>(i);
        const auto first = static_cast<std::uint32_t>(mesh.points.size());
        for (const openvdb::Vec3s& p :
             {openvdb::Vec3s(0.3f, -0.2f, z), openvdb::Vec3s(6.1f, 0.4f, z),
              openvdb::Vec3s(1.7f, 5.3f, z + 2)})
            mesh.points.push_back(p);
        mesh.triangles.emplace_back(first, first + 1, first + 2);
    }
    return mesh;
}

TEST(VoxelDistances, AreThoseToTheNearestTriangleWithinTheBand)
{
    const TriangleMesh mesh = sheets(3, 4.5f);
    const FloatGridPtr grid = unsigned_distances_by_voxels(mesh, kBand);
    std::uint64_t within = 0;
    for (int x = -8; x < 16; ++x)
        for (int y = -8; y < 16; ++y)
            for (int z = -8; z < 22; ++z) {
                const openvdb::Coord voxel(x, y, z);
                double distance = kBand;
                for (std::uint32_t t = 0; t < 3; ++t)
                    distance = std::min(
                        distance,
                        (nearest_on_triangle(triangle_corners(mesh, t), voxel.asVec3d()).point -
                         voxel.asVec3d())
                            .length());
                const bool near = static_cast<float>(distance) < static_cast<float>(kBand);
                within += near;
                EXPECT_EQ(grid->tree().isValueOn(voxel), near) << voxel;
                EXPECT_NEAR(grid->tree().getValue(voxel), distance, 1e-6) << voxel;
            }
    EXPECT_EQ(grid->activeVoxelCount(), within) << "none lies beyond the box that was looked at";
    EXPECT_GT(within, 500U);
}

TEST(VoxelDistances, FillVoxelsWhereManySheetsLieInEachVoxelOfTheBox)
{
    EXPECT_FALSE(fills_voxels(TriangleMesh{}, kBand));
    EXPECT_FALSE(fills_voxels(sheets(10, 1.0f), kBand));
    EXPECT_TRUE(fills_voxels(sheets(4000, 0.001f), kBand));
    EXPECT_FALSE(fills_voxels(sheets(4000, 1.0f), kBand)) << "one a voxel";
}

} // namespace
