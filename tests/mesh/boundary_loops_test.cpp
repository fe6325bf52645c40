// SPDX-License-Identifier: Apache-2.0
#include "mesh/boundary_loops.h"

#include <gtest/gtest.h>

namespace
{

using namespace vdb_shell;

TEST(BoundaryWalks, PartWhereLoopsMeetInAPoint)
{
    const std::vector<Edge> edges{{0, 1}, {0, 2}, {0, 3}, {0, 4}, {1, 2}, {3, 4}};
    const std::vector<BoundaryWalk> walks = boundary_walks(edges);
    ASSERT_EQ(walks.size(), 2u);
    for (const BoundaryWalk& walk : walks) {
        EXPECT_TRUE(walk.closed);
        EXPECT_EQ(walk.points.size(), 3u);
    }
}

TEST(BoundaryWalks, EndAtPointsOfAnOddNumberOfEdges)
{
    const std::vector<BoundaryWalk> walks = boundary_walks({{5, 7}, {5, 9}, {7, 9}, {9, 11}});
    ASSERT_EQ(walks.size(), 2u);
    EXPECT_EQ(walks[0].closed + walks[1].closed, 1);
}

// A search along the path for each point would take some hours here, and CTest end it.
TEST(BoundaryWalks, TakeALoopOfAMillionEdgesAndAPointOfAMillion)
{
    constexpr std::uint32_t kEdges = 1'000'000;
    std::vector<Edge> ring{{0, kEdges - 1}};
    for (std::uint32_t i = 1; i < kEdges; ++i)
        ring.push_back({i - 1, i});
    const std::vector<BoundaryWalk> loop = boundary_walks(ring);
    ASSERT_EQ(loop.size(), 1u);
    EXPECT_EQ(loop[0].points.size(), kEdges);
    std::vector<Edge> petals; // triangles that have the point 0 in common
    for (std::uint32_t i = 1; i < kEdges; i += 2) {
        petals.push_back({0, i});
        petals.push_back({0, i + 1});
        petals.push_back({i, i + 1});
    }
    EXPECT_EQ(boundary_walks(petals).size(), kEdges / 2);
}

} // namespace
