// SPDX-License-Identifier: Apache-2.0
#include "mesh/most_visible.h"

#include "support/shapes.h"

#include <gtest/gtest.h>

#include <cmath>

namespace
{

using namespace vdb_shell;
using openvdb::Vec3d;

TEST(MostVisible, IsAsFarFromAllThreeAxes)
{
    const Vec3d d = most_visible({{1, 0, 0}, {0, 1, 0}, {0, 0, 1}});
    for (int k = 0; k < 3; ++k)
        EXPECT_NEAR(d[k], 1 / std::sqrt(3.0), 1e-12);
}

TEST(MostVisible, LeavesOutNormalsThatSayNothingNew)
{
    // The widest angle is that between the first two; the third lies between them.
    const Vec3d d = most_visible({{1, 0, 0}, {0, 1, 0}, Vec3d(1, 1, 0).unit()});
    EXPECT_NEAR(smallest_dot({{1, 0, 0}, {0, 1, 0}}, d), std::sqrt(0.5), 1e-12);
    EXPECT_NEAR(d[2], 0, 1e-12);
}

TEST(MostVisible, NoDirectionSeesOppositeNormals)
{
    const std::vector<Vec3d> normals{{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}};
    EXPECT_LE(smallest_dot(normals, most_visible(normals)), 0);
}

TEST(MostVisible, ManyNormalsOfACone)
{
    // More than are tried by triples: all at 60 degrees from the axis.
    std::vector<Vec3d> normals;
    for (int i = 0; i < 40; ++i) {
        const double angle = 2 * M_PI * i / 40;
        normals.emplace_back(std::sqrt(0.75) * std::cos(angle), std::sqrt(0.75) * std::sin(angle),
                             0.5);
    }
    EXPECT_NEAR(smallest_dot(normals, most_visible(normals)), 0.5, 1e-3);
}

TEST(BlindVertices, ABoxHasNone)
{
    EXPECT_TRUE(blind_vertices(test::box(Vec3d(0.0), Vec3d(1.0))).empty());
}

TEST(BlindVertices, FindsTheCornerOfTwoTrianglesThatFaceOppositeWays)
{
    TriangleMesh mesh;
    for (const auto& p : {openvdb::Vec3s(0, 0, 0), openvdb::Vec3s(1, 0, 0), openvdb::Vec3s(0, 1, 0),
                          openvdb::Vec3s(-1, 0, 0), openvdb::Vec3s(0, -1, 0)})
        mesh.points.push_back(p);
    mesh.triangles = {openvdb::Vec3I(0, 1, 2), openvdb::Vec3I(0, 4, 3)};
    EXPECT_EQ(blind_vertices(mesh), std::vector<std::uint32_t>{0});
    mesh.triangles[1] = openvdb::Vec3I(0, 3, 4);
    EXPECT_TRUE(blind_vertices(mesh).empty());
}

} // namespace
