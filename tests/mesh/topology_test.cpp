// SPDX-License-Identifier: Apache-2.0
#include "mesh/topology.h"

#include "support/shapes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

namespace vdb_shell
{
namespace
{

// One that a thread does by itself, and one that several do.
TEST(Topology, ListsTheTrianglesAroundEachVertexInAscendingOrder)
{
    for (const int subdivisions : {1, 6}) {
        const TriangleMesh ball = test::icosphere(1, subdivisions);
        // The last vertex has no triangle.
        const std::size_t vertices = ball.points.size() + 1;
        std::vector<std::vector<std::uint32_t>> wanted(vertices);
        for (std::uint32_t t = 0; t < ball.triangles.size(); ++t)
            for (int k = 0; k < 3; ++k)
                wanted[ball.triangles[t][k]].push_back(t);
        const VertexTriangles found = triangles_around_vertices(vertices, ball.triangles);
        for (std::size_t v = 0; v < vertices; ++v) {
            const auto around = found.around(v);
            ASSERT_TRUE(
                std::equal(around.begin(), around.end(), wanted[v].begin(), wanted[v].end()))
                << v;
        }
    }
}

TEST(Topology, RimsTurnRoundClosedFans)
{
    const TriangleMesh ball = test::icosphere(1, 6);
    const Rims rims = rims_around_vertices(ball.points.size(), ball.triangles);
    for (std::size_t v = 0; v < ball.points.size(); ++v) {
        const auto rim = rims.of(v);
        ASSERT_EQ(rim.size(), rims.around.around(v).size()) << v;
        for (std::size_t i = 0; i < rim.size(); ++i) {
            const std::uint32_t a = rim.begin()[i], b = rim.begin()[(i + 1) % rim.size()];
            const auto around = rims.around.around(v);
            EXPECT_TRUE(std::any_of(around.begin(), around.end(), [&](std::uint32_t t) {
                const openvdb::Vec3I& c = ball.triangles[t];
                for (int k = 0; k < 3; ++k)
                    if (c[k] == v && c[(k + 1) % 3] == a && c[(k + 2) % 3] == b)
                        return true;
                return false;
            }));
        }
    }
}

} // namespace
} // namespace vdb_shell
