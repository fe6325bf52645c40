// SPDX-License-Identifier: Apache-2.0
#include "vdb_shell/mesh/normals.h"
#include "vdb_shell/step/limits.h"

#include "core/grid_instances.h"
#include "support/shapes.h"
#include "vdb_shell/core/error.h"

#include <gmock/gmock-matchers.h>
#include <gtest/gtest.h>

#include <cmath>

namespace vdb_shell
{
namespace
{

using openvdb::Vec3d;

Directions radial(const TriangleMesh& mesh)
{
    std::vector<Vec3d> outward;
    for (const auto& p : mesh.points)
        outward.push_back(Vec3d(p).unit());
    return directions_along(mesh, outward);
}

TEST(Limits, SphereFoldsAtItsCentreEverywhere)
{
    const TriangleMesh mesh = test::icosphere(2, 3);
    for (const double limit : triangle_limits(mesh, radial(mesh)))
        EXPECT_NEAR(limit, 2, 1e-3);
    for (const double limit : vertex_limits(mesh, radial(mesh), Limit::uniform))
        EXPECT_NEAR(limit, 2, 1e-3);
}

TEST(Limits, HollowBallNeverFoldsOnItsInnerSurface)
{
    // Seen from the solid the surface of a cavity is concave: "inward" leads away from the centre.
    const TriangleMesh cavity = test::reversed(test::icosphere(1, 2));
    std::vector<Vec3d> outward;
    for (const auto& p : cavity.points)
        outward.push_back(-Vec3d(p).unit());
    for (const double limit : triangle_limits(cavity, directions_along(cavity, outward)))
        EXPECT_TRUE(std::isinf(limit)) << limit;
}

TEST(Limits, ParallelDirectionsNeverFold)
{
    const TriangleMesh mesh = test::unit_tetrahedron();
    const std::vector<Vec3d> same(mesh.points.size(), Vec3d(1, 2, 3).unit());
    for (const double limit : triangle_limits(mesh, directions_along(mesh, same)))
        EXPECT_TRUE(std::isinf(limit));
}

TEST(Limits, TwoPillarsThatMeetAreTheAnswerOfALinearEquation)
{
    // Pillars 0 and 1 lean towards each other by 45 degrees over a distance of 1: they meet after
    // sqrt(1/2), pillar 2 goes straight down.
    TriangleMesh mesh{{{0, 0, 0}, {1, 0, 0}, {0.5f, 1, 0}}, {{0, 1, 2}}};
    const std::vector<Vec3d> outward{Vec3d(-1, 0, 1).unit(), Vec3d(1, 0, 1).unit(), Vec3d(0, 0, 1)};
    const double limit = triangle_limits(mesh, directions_along(mesh, outward))[0];
    EXPECT_LE(limit, std::sqrt(0.5) + 1e-12);
    EXPECT_GT(limit, 0.5);
}

TEST(Limits, LimitIsWhereTheJacobianVanishes)
{
    const TriangleMesh mesh = test::torus(1, 0.4, 16, 9);
    const Directions directions = directions_along(mesh, pseudo_normals(mesh));
    const auto limits = triangle_limits(mesh, directions);
    const auto least_jacobian = [&](const openvdb::Vec3I& t, double e) {
        const auto at = [&](int i) {
            return Vec3d(mesh.points[t[i]]) + e * directions.inward[t[i]];
        };
        const Vec3d area = (at(1) - at(0)).cross(at(2) - at(0));
        double least = 1e300;
        for (int i = 0; i < 3; ++i)
            least = std::min(least, -directions.inward[t[i]].dot(area));
        return least;
    };
    for (std::size_t i = 0; i < limits.size(); ++i) {
        ASSERT_TRUE(std::isfinite(limits[i]));
        const double whole = least_jacobian(mesh.triangles[i], 0);
        EXPECT_NEAR(least_jacobian(mesh.triangles[i], limits[i]), 0, 1e-8 * whole);
        for (const double part : {0.1, 0.5, 0.9, 0.999})
            EXPECT_GT(least_jacobian(mesh.triangles[i], part * limits[i]), 0);
    }
}

TEST(Limits, AdaptiveIsTheSmallestAroundEachVertexAndNeverBelowUniform)
{
    const TriangleMesh mesh = test::torus(1, 0.4, 16, 9);
    const Directions directions = directions_along(mesh, pseudo_normals(mesh));
    const auto triangles = triangle_limits(mesh, directions);
    const auto adaptive = vertex_limits(mesh, directions, Limit::adaptive);
    const auto uniform = vertex_limits(mesh, directions, Limit::uniform);
    const double least = *std::min_element(triangles.begin(), triangles.end());
    for (std::size_t v = 0; v < adaptive.size(); ++v) {
        EXPECT_EQ(uniform[v], least);
        EXPECT_GE(adaptive[v], uniform[v]);
    }
    for (std::size_t t = 0; t < triangles.size(); ++t)
        for (int i = 0; i < 3; ++i)
            EXPECT_LE(adaptive[mesh.triangles[t][i]], triangles[t]);
    EXPECT_TRUE(std::isinf(vertex_limits(mesh, directions, Limit::none)[0]));
}

TEST(Limits, CutLengthsAndSayWhichOnes)
{
    LineLengths lengths{{1.0, 3.0, INFINITY},
                        {2, 6, 0},
                        {StopReason::stop_test, StopReason::thickness, StopReason::none}};
    apply_limits(lengths, {2.0, 2.0, 2.0});
    EXPECT_THAT(lengths.length, ::testing::ElementsAre(1.0, 2.0, 2.0));
    EXPECT_EQ(lengths.reason[0], StopReason::stop_test);
    EXPECT_EQ(lengths.reason[1], StopReason::limit);
    EXPECT_EQ(lengths.reason[2], StopReason::limit);
}

TEST(Limits, RefuseALengthThatStaysInfinite)
{
    LineLengths lengths{{1.0, INFINITY}, {0, 0}, {StopReason::none, StopReason::none}};
    try {
        apply_limits(lengths, {2.0, INFINITY});
        FAIL();
    } catch (const GeometryError& error) {
        EXPECT_THAT(error.what(), ::testing::HasSubstr("vertex 1"));
    }
}

} // namespace
} // namespace vdb_shell
