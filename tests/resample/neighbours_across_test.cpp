// SPDX-License-Identifier: Apache-2.0
#include "resample/neighbours_across.h"

#include "support/shapes.h"

#include <gtest/gtest.h>

namespace vdb_shell::test
{
namespace
{

using openvdb::Vec3I;

TEST(NeighboursAcross, ShareTheSideAndRunThroughItTheOtherWay)
{
    const TriangleMesh mesh = icosphere(1.0, 2);
    const auto across = neighbours_across(mesh.triangles);
    ASSERT_EQ(across.size(), mesh.triangles.size());
    for (std::size_t t = 0; t < across.size(); ++t)
        for (int side = 0; side < 3; ++side) {
            const std::uint32_t u = across[t][std::size_t(side)];
            ASSERT_NE(u, kNoNeighbour);
            const Vec3I &one = mesh.triangles[t], &other = mesh.triangles[u];
            bool found = false;
            for (int k = 0; k < 3; ++k)
                if (other[k] == one[(side + 1) % 3] && other[(k + 1) % 3] == one[side]) {
                    found = true;
                    EXPECT_EQ(across[u][std::size_t(k)], t);
                }
            EXPECT_TRUE(found);
        }
}

TEST(NeighboursAcross, AreNoneAtRimsAtEdgesOfThreeAndWhereTrianglesAreTurned)
{
    const auto none = [](const std::vector<Vec3I>& triangles) {
        std::size_t count = 0;
        for (const NeighboursAcross& sides : neighbours_across(triangles))
            for (const std::uint32_t t : sides)
                count += t == kNoNeighbour;
        return count;
    };
    EXPECT_EQ(none({{0, 1, 2}}), 3U);
    EXPECT_EQ(none({{0, 1, 2}, {1, 0, 3}}), 4U);
    EXPECT_EQ(none({{0, 1, 2}, {0, 1, 3}}), 6U);            // both run from 0 to 1
    EXPECT_EQ(none({{0, 1, 2}, {1, 0, 3}, {1, 0, 4}}), 9U); // three on one edge
}

} // namespace
} // namespace vdb_shell::test
