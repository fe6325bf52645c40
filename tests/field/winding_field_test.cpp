// SPDX-License-Identifier: Apache-2.0
#include "field/winding_field.h"

#include "support/shapes.h"
#include "support/solid_angles.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace vdb_shell::test
{
namespace
{

using openvdb::Vec3d;

std::vector<TriangleCorners> corners_of(const TriangleMesh& mesh)
{
    std::vector<TriangleCorners> triangles;
    for (const openvdb::Vec3I& t : mesh.triangles)
        triangles.push_back(
            {Vec3d(mesh.points[t[0]]), Vec3d(mesh.points[t[1]]), Vec3d(mesh.points[t[2]])});
    return triangles;
}

/// Triangles of one size in a cube from -1 to 1, turned all ways.
std::vector<TriangleCorners> loose_triangles(std::size_t count, double size)
{
    std::mt19937 source(7);
    std::uniform_real_distribution<double> uniform(-1, 1);
    const auto any = [&] { return Vec3d(uniform(source), uniform(source), uniform(source)); };
    std::vector<TriangleCorners> triangles(count);
    for (TriangleCorners& t : triangles) {
        const Vec3d middle = any();
        for (Vec3d& corner : t)
            corner = middle + size * any();
    }
    return triangles;
}

std::vector<Vec3d> lattice(int along, double half)
{
    std::vector<Vec3d> points;
    for (int i = 0; i < along; ++i)
        for (int j = 0; j < along; ++j)
            for (int k = 0; k < along; ++k)
                points.push_back(half * (2.0 * Vec3d(i, j, k) / (along - 1) - Vec3d(1.0)));
    return points;
}

TEST(WindingField, IsTheSumOfSolidAnglesOfLooseTriangles)
{
    const auto triangles = loose_triangles(3000, 0.08);
    const std::vector<Vec3d> points = lattice(30, 1.3);
    const std::vector<float> turns = turns_at(WindingNumber(triangles), points);
    double worst = 0, squares = 0;
    std::size_t looked_at = 0;
    for (std::size_t i = 0; i < points.size(); i += 17, ++looked_at) {
        double exact = 0;
        for (const TriangleCorners& t : triangles)
            exact += turns_of(t, points[i]);
        worst = std::max(worst, std::abs(double(turns[i]) - exact));
        squares += std::pow(double(turns[i]) - exact, 2);
    }
    EXPECT_LT(worst, 0.02);
    EXPECT_LT(std::sqrt(squares / double(looked_at)), 0.005);
}

TEST(WindingField, IsOneInAClosedSurfaceAndNoneOutside)
{
    const std::vector<Vec3d> points = lattice(40, 1.5);
    const std::vector<float> turns = turns_at(WindingNumber(corners_of(icosphere(1.0, 5))), points);
    for (std::size_t i = 0; i < points.size(); ++i) {
        const double radius = points[i].length();
        if (std::abs(radius - 1) < 0.002)
            continue;
        ASSERT_NEAR(turns[i], radius < 1 ? 1.0 : 0.0, 0.03) << points[i];
    }
}

// Each is answered by itself, whatever it is asked with: far from the others, in one place with
// them, alone.
TEST(WindingField, TakesAnyPoints)
{
    const WindingNumber ball(corners_of(icosphere(1.0, 3)));
    std::vector<Vec3d> points(500, Vec3d(0.1, 0.2, 0.3));
    points.emplace_back(1e6, 0, 0);
    for (std::size_t i = 0; i < 300; ++i)
        points.emplace_back(1.5, 0.001 * double(i), 0);
    const std::vector<float> turns = turns_at(ball, points);
    for (std::size_t i = 0; i < points.size(); ++i)
        ASSERT_NEAR(turns[i], i < 500 ? 1.0 : 0.0, 0.02) << i;
    EXPECT_NEAR(turns_at(ball, {Vec3d(0.0)}).at(0), 1.0, 0.02);
    EXPECT_TRUE(turns_at(ball, {}).empty());
    EXPECT_EQ(turns_at(WindingNumber({}), points), std::vector<float>(points.size(), 0.0F));
}

TEST(WindingField, IsTheSameForAnyNumberOfThreads)
{
    const WindingNumber winding(loose_triangles(2000, 0.1));
    const std::vector<Vec3d> points = lattice(36, 1.2);
    const std::vector<float> many = turns_at(winding, points);
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, 1);
    EXPECT_EQ(turns_at(winding, points), many);
}

} // namespace
} // namespace vdb_shell::test
