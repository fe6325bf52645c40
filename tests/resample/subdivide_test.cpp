// SPDX-License-Identifier: Apache-2.0
#include "vdb_shell/resample/subdivide.h"

#include "vdb_shell/core/error.h"
#include "vdb_shell/mesh/check_mesh.h"
#include "vdb_shell/resample/surface_distance.h"

#include "support/shapes.h"

#include <gtest/gtest.h>

#include <string>

namespace vdb_shell::test
{
namespace
{

double area_of(const TriangleMesh& mesh)
{
    double area = 0;
    for (const openvdb::Vec3I& t : mesh.triangles) {
        const openvdb::Vec3d a(mesh.points[t[0]]), b(mesh.points[t[1]]), c(mesh.points[t[2]]);
        area += 0.5 * (b - a).cross(c - a).length();
    }
    return area;
}

TEST(Subdivide, CutsEachTriangleInFourAndKeepsTheShape)
{
    const TriangleMesh shape =
        translated(turned(torus(1.0, 0.3, 12, 8), {1, 2, 3}, 0.4), {5, 0, 0});
    TriangleMesh coarse = shape;
    for (int levels = 1; levels <= 2; ++levels) {
        const TriangleMesh fine = subdivide(shape, {levels});
        EXPECT_EQ(fine.triangles.size(), 4 * coarse.triangles.size());
        // A middle for each edge; a closed surface has three edges for two triangles.
        EXPECT_EQ(fine.points.size(), coarse.points.size() + coarse.triangles.size() * 3 / 2);
        const MeshCheck check = check_mesh(fine);
        EXPECT_TRUE(check.closed() && check.manifold() && check.embedded());
        EXPECT_EQ(check.degenerate_triangles.count, 0U);
        EXPECT_NEAR(check.volume, check_mesh(shape).volume, 1e-6);
        EXPECT_NEAR(area_of(fine), area_of(shape), 1e-5);
        // Half a unit in the last place of coordinates below 8, along three axes.
        constexpr double kRounding = 2.4e-7 * 1.7321 * 2;
        EXPECT_LE(surface_distance(fine, shape, 0.05).max, kRounding);
        EXPECT_LE(surface_distance(shape, fine, 0.05).max, kRounding);
        coarse = fine;
    }
}

TEST(Subdivide, IsExactWhereTheMiddlesAreFloats)
{
    const TriangleMesh cube = box({0, 0, 0}, {1, 2, 4});
    const TriangleMesh fine = subdivide(cube, {3});
    EXPECT_EQ(fine.triangles.size(), 12U * 64U);
    EXPECT_EQ(signed_volume(fine.points, fine.triangles), 8.0);
    EXPECT_EQ(area_of(fine), 28.0);
    for (std::size_t v = 0; v < cube.points.size(); ++v)
        EXPECT_EQ(fine.points[v], cube.points[v]);
    for (const openvdb::Vec3I& t : fine.triangles) // all pieces are as large as their siblings
        EXPECT_NE(t[0], t[1]);
}

TEST(Subdivide, NoLevelsChangeNothing)
{
    const TriangleMesh mesh = icosphere(1.0, 1);
    const TriangleMesh same = subdivide(mesh, {0});
    EXPECT_EQ(same.points, mesh.points);
    EXPECT_EQ(same.triangles, mesh.triangles);
}

TEST(Subdivide, RefusesLevelsThatMakeNoSense)
{
    for (const int levels : {-1, 14, 1000})
        try {
            subdivide(icosphere(1.0, 1), {levels});
            FAIL() << levels << " levels were taken";
        } catch (const InvalidOption& error) {
            EXPECT_NE(std::string(error.what()).find("levels is " + std::to_string(levels)),
                      std::string::npos);
        }
}

} // namespace
} // namespace vdb_shell::test
