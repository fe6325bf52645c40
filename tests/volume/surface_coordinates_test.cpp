// SPDX-License-Identifier: Apache-2.0
#include "vdb_shell/volume/surface_coordinates.h"

#include "support/shapes.h"
#include "vdb_shell/core/error.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace vdb_shell
{
namespace
{

using openvdb::Vec2d;
using openvdb::Vec3s;

/// Each side of the box is a chart of its own: ten times the number of the side, and the two
/// coordinates in it.
Vec2d on_side(int side, const Vec3s& p)
{
    const int axis = side / 2;
    return {10 * side + double(p[(axis + 1) % 3]), double(p[(axis + 2) % 3])};
}

int side_of(const TriangleMesh& mesh, const openvdb::Vec3I& t)
{
    for (int axis = 0; axis < 3; ++axis) {
        const float a = mesh.points[t[0]][axis];
        if (mesh.points[t[1]][axis] == a && mesh.points[t[2]][axis] == a)
            return 2 * axis + (a > 0.5f);
    }
    return -1;
}

TextureCoordinates textured_box(int n)
{
    TextureCoordinates made{test::gridded_box({0, 0, 0}, {1, 1, 1}, n), {}};
    for (const openvdb::Vec3I& t : made.mesh.triangles) {
        auto& corner = made.corner.emplace_back();
        for (int k = 0; k < 3; ++k)
            corner[std::size_t(k)] = on_side(side_of(made.mesh, t), made.mesh.points[t[k]]);
    }
    return made;
}

TEST(SurfaceCoordinates, OfTheSameTrianglesAreTakenAsTheyAre)
{
    const TextureCoordinates box = textured_box(3);
    TriangleMesh mixed = box.mesh;
    std::reverse(mixed.triangles.begin(), mixed.triangles.end());
    for (openvdb::Vec3I& t : mixed.triangles)
        t = {t[1], t[2], t[0]};
    const SurfaceCoordinates made = surface_coordinates(box, mixed);
    EXPECT_EQ(made.same, mixed.triangles.size());
    EXPECT_EQ(made.farthest, 0);
    for (std::size_t t = 0; t < mixed.triangles.size(); ++t)
        for (int k = 0; k < 3; ++k)
            EXPECT_EQ(made.corner[t][std::size_t(k)], on_side(side_of(mixed, mixed.triangles[t]),
                                                              mixed.points[mixed.triangles[t][k]]));
}

TEST(SurfaceCoordinates, OfOtherTrianglesStayOnTheirSideOfASeam)
{
    for (const auto& [from, to] : {std::pair{3, 4}, std::pair{2, 7}, std::pair{7, 2}}) {
        const TriangleMesh other = textured_box(to).mesh;
        const SurfaceCoordinates made = surface_coordinates(textured_box(from), other);
        EXPECT_LT(made.same, other.triangles.size());
        EXPECT_LT(made.farthest, 1e-6);
        for (std::size_t t = 0; t < other.triangles.size(); ++t)
            for (int k = 0; k < 3; ++k)
                EXPECT_LT(
                    (made.corner[t][std::size_t(k)] - on_side(side_of(other, other.triangles[t]),
                                                              other.points[other.triangles[t][k]]))
                        .length(),
                    1e-5);
    }
}

/// A torus with u around it, cut at 0: one chart, both of whose ends lie at the seam.
TextureCoordinates textured_torus(int around)
{
    TextureCoordinates made{test::torus(1.0, 0.4, around, 12), {}};
    for (const openvdb::Vec3I& t : made.mesh.triangles) {
        auto& corner = made.corner.emplace_back();
        for (int k = 0; k < 3; ++k) {
            const Vec3s& p = made.mesh.points[t[k]];
            const double u = std::atan2(double(p[1]), double(p[0])) / (2 * M_PI);
            corner[std::size_t(k)] = {u < -1e-9 ? u + 1 : u, 0};
        }
        double least = 1;
        for (const Vec2d& uv : corner)
            least = std::min(least, uv[0]);
        const double most = std::max({corner[0][0], corner[1][0], corner[2][0]});
        for (Vec2d& uv : corner)
            if (most - least > 0.5 && uv[0] < 0.5)
                uv[0] += 1;
    }
    return made;
}

TEST(SurfaceCoordinates, NoTriangleReachesFromOneEndOfAChartToTheOther)
{
    const TriangleMesh other = test::turned(test::torus(1.0, 0.4, 31, 12), {0, 0, 1}, 0.05);
    const SurfaceCoordinates made = surface_coordinates(textured_torus(24), other);
    EXPECT_EQ(made.same, 0U);
    EXPECT_GT(made.farthest, 0);
    for (const auto& corner : made.corner) {
        const auto [low, high] = std::minmax({corner[0][0], corner[1][0], corner[2][0]});
        // A triangle of 31 around, and a little for surfaces that are not the same.
        EXPECT_LT(high - low, 1.3 / 31);
        EXPECT_GT(high - low, 0.7 / 31);
    }
}

TEST(SurfaceCoordinates, NeedATexturedSurface)
{
    EXPECT_THROW(surface_coordinates({}, test::icosphere(1, 1)), InvalidOption);
}

} // namespace
} // namespace vdb_shell
