// SPDX-License-Identifier: Apache-2.0
#include "field/winding_number.h"

#include "support/shapes.h"
#include "support/solid_angles.h"

#include <gtest/gtest.h>

#include <cmath>
#include <utility>

namespace vdb_shell::test
{
namespace
{

using openvdb::Vec3d;

TEST(WindingNumber, CountsTheTurnsOfClosedSurfaces)
{
    const TriangleMesh mesh = icosphere(1.0, 4);
    std::vector<TriangleCorners> triangles;
    for (const openvdb::Vec3I& t : mesh.triangles)
        triangles.push_back(
            {Vec3d(mesh.points[t[0]]), Vec3d(mesh.points[t[1]]), Vec3d(mesh.points[t[2]])});
    const WindingNumber winding(triangles);
    const auto turns = [&](const std::vector<Vec3d>& points) {
        std::vector<float> out(points.size());
        winding.around(points.data(), points.size(), out.data());
        return out;
    };
    const Vec3d way(0.6, 0.0, 0.8);
    for (const double r : {0.0, 0.5, 0.95, 0.99})
        EXPECT_NEAR(turns({way * r})[0], 1.0, 0.02) << r;
    for (const double r : {1.01, 1.05, 2.0, 50.0})
        EXPECT_NEAR(turns({way * r})[0], 0.0, 0.02) << r;
    // Together they are seen from farther off, and a group need not be full.
    const std::vector<double> radii{0.9, 0.99, 1.01, 1.1, 0.5, 1.5, 0.7, 1.3, 0.2};
    std::vector<Vec3d> points;
    for (const double r : radii)
        points.push_back(way * r);
    const std::vector<float> together = turns(points);
    for (std::size_t i = 0; i < radii.size(); ++i)
        EXPECT_NEAR(together[i], radii[i] < 1 ? 1.0 : 0.0, 0.02) << radii[i];
    float none = 1;
    const Vec3d origin(0.0);
    WindingNumber({}).around(&origin, 1, &none);
    EXPECT_EQ(none, 0.0F);
}

// Laps of the product of many numbers: triangles one over the other, seen from both sides, add up
// to many turns.
TEST(WindingNumber, AddsUpTrianglesThatLieOverEachOther)
{
    std::vector<TriangleCorners> triangles;
    for (int i = 0; i < 40; ++i) {
        const double z = 0.01 * i;
        triangles.push_back({Vec3d(-3, -2, z), Vec3d(4, -2.5, z), Vec3d(0.3, 3, z)});
        if (i % 5 == 0)
            std::swap(triangles.back()[0], triangles.back()[1]);
    }
    const WindingNumber winding(triangles);
    for (const double z : {-0.3, -0.005, 0.055, 0.205, 0.395, 0.7}) {
        const std::vector<Vec3d> points{Vec3d(0.1, 0.2, z), Vec3d(-0.5, 0.1, z), Vec3d(5, 5, z)};
        std::vector<float> turns(points.size());
        winding.around(points.data(), points.size(), turns.data());
        for (std::size_t i = 0; i < points.size(); ++i) {
            double exact = 0;
            for (const TriangleCorners& t : triangles)
                exact += turns_of(t, points[i]);
            EXPECT_NEAR(turns[i], exact, 1e-3) << z << " point " << i;
        }
    }
}

} // namespace
} // namespace vdb_shell::test
