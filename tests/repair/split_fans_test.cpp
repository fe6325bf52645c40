// SPDX-License-Identifier: Apache-2.0
#include "vdb_shell/repair/split_fans.h"

#include "support/shapes.h"

#include <gtest/gtest.h>

namespace
{

using namespace vdb_shell;
using openvdb::Vec3d;
using openvdb::Vec3I;
using openvdb::Vec3s;

/// Two tetrahedra that share vertex 0 and lie on either side of it.
TriangleMesh hourglass()
{
    TriangleMesh mesh = test::unit_tetrahedron();
    for (const Vec3s& p : {Vec3s(-1, 0, 0), Vec3s(0, -1, 0), Vec3s(0, 0, -1)})
        mesh.points.push_back(p);
    const std::size_t count = mesh.triangles.size();
    for (std::size_t t = 0; t < count; ++t) {
        Vec3I mirrored = mesh.triangles[t];
        std::swap(mirrored[1], mirrored[2]);
        for (int k = 0; k < 3; ++k)
            mirrored[k] += mirrored[k] > 0 ? 3U : 0U;
        mesh.triangles.push_back(mirrored);
    }
    return mesh;
}

TEST(SplitFans, GivesTheSecondFanACopy)
{
    const TriangleMesh mesh = hourglass();
    ASSERT_EQ(check_mesh(mesh).non_manifold_vertices.first, std::vector<std::uint32_t>{0});
    const FanSplit split = split_fans(mesh);
    EXPECT_EQ(split.vertices.count, 1U);
    EXPECT_EQ(split.vertices.first, std::vector<std::uint32_t>{0});
    EXPECT_EQ(split.copies, 1U);
    ASSERT_EQ(split.mesh.points.size(), 8U);
    EXPECT_EQ(split.mesh.points[7], mesh.points[0]);
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
        for (int k = 0; k < 3; ++k) {
            const std::uint32_t old = mesh.triangles[t][k];
            EXPECT_EQ(split.mesh.triangles[t][k], old == 0 && t >= 4 ? 7U : old) << t;
        }
    const MeshCheck check = check_mesh(split.mesh);
    EXPECT_TRUE(check.manifold());
    EXPECT_TRUE(check.closed());
    EXPECT_EQ(check.components.size(), 2U);
    // Three triangles of either fan meet in the point.
    EXPECT_EQ(check.self_intersections.count, 9U);
    EXPECT_NEAR(check.volume, 2.0 / 6, 1e-12);
}

TEST(SplitFans, LeavesASoundSurfaceAsItIs)
{
    for (const TriangleMesh& mesh : {test::icosphere(1, 2), test::torus(1, 0.3, 12, 8),
                                     test::gridded_box({0, 0, 0}, {1, 1, 1}, 3)}) {
        const FanSplit split = split_fans(mesh);
        EXPECT_EQ(split.vertices.count, 0U);
        EXPECT_EQ(split.mesh.points, mesh.points);
        EXPECT_EQ(split.mesh.triangles, mesh.triangles);
    }
}

TEST(SplitFans, KeepsTogetherWhatMeetsInAnEdgeOfFourTriangles)
{
    // Two boxes with a common edge: its ends are one fan each through that edge.
    TriangleMesh mesh = test::joined(test::box(Vec3d(0, 0, 0), Vec3d(1, 1, 1)),
                                     test::box(Vec3d(1, 1, 0), Vec3d(2, 2, 1)));
    for (Vec3I& triangle : mesh.triangles)
        for (int k = 0; k < 3; ++k)
            for (std::uint32_t v = 0; v < 8; ++v)
                if (mesh.points[v] == mesh.points[triangle[k]])
                    triangle[k] = v;
    ASSERT_EQ(check_mesh(mesh).non_manifold_edges.count, 1U);
    const FanSplit split = split_fans(mesh);
    EXPECT_EQ(split.copies, 0U);
    EXPECT_EQ(check_mesh(split.mesh).non_manifold_edges.count, 1U);
}

TEST(SplitFans, CountsSeveralFansAtOneVertex)
{
    // Four octants' tetrahedra around the origin that share nothing but it.
    TriangleMesh mesh;
    mesh.points.emplace_back(0.0f);
    for (const Vec3s& sign :
         {Vec3s(1, 1, 1), Vec3s(-1, -1, 1), Vec3s(1, -1, -1), Vec3s(-1, 1, -1)}) {
        const auto base = static_cast<std::uint32_t>(mesh.points.size());
        mesh.points.push_back(sign * Vec3s(1, 0.1f, 0.1f));
        mesh.points.push_back(sign * Vec3s(0.1f, 1, 0.1f));
        mesh.points.push_back(sign * Vec3s(0.1f, 0.1f, 1));
        for (const Vec3I& t : {Vec3I(0, base + 1, base), Vec3I(0, base + 2, base + 1),
                               Vec3I(0, base, base + 2), Vec3I(base, base + 1, base + 2)})
            mesh.triangles.push_back(t);
    }
    const FanSplit split = split_fans(mesh);
    EXPECT_EQ(split.vertices.count, 1U);
    EXPECT_EQ(split.copies, 3U);
    EXPECT_TRUE(check_mesh(split.mesh).manifold());
}

} // namespace
