// SPDX-License-Identifier: Apache-2.0
#include "resample/flat_parts.h"

#include "support/shapes.h"

#include <gtest/gtest.h>

#include <set>

namespace vdb_shell::test
{
namespace
{

using openvdb::Vec3d;
using openvdb::Vec3s;

FlatParts parts_of(const TriangleMesh& mesh, double thickness)
{
    return flat_parts(mesh, neighbours_across(mesh.triangles), thickness);
}

TEST(FlatParts, AreTheSixSidesOfABoxEachSeenAlongItsAxis)
{
    const TriangleMesh mesh = gridded_box({0, 0, 0}, {1, 2, 3}, 4);
    const FlatParts flat = parts_of(mesh, 1e-9);
    ASSERT_EQ(flat.parts.size(), 6U);
    std::set<std::pair<int, int>> sides;
    std::size_t triangles = 0;
    for (const FlatPart& part : flat.parts) {
        sides.insert({part.axis, part.turn});
        triangles += part.triangles.size();
        EXPECT_LT(part.thickness, 1e-12);
        for (const std::uint32_t t : part.triangles) {
            EXPECT_TRUE(turns(mesh, mesh.triangles[t], part));
            const Vec3s &a = mesh.points[mesh.triangles[t][0]],
                        &b = mesh.points[mesh.triangles[t][1]],
                        &c = mesh.points[mesh.triangles[t][2]];
            EXPECT_EQ(a[part.axis], b[part.axis]);
            EXPECT_EQ(a[part.axis], c[part.axis]);
            EXPECT_GT((b - a).cross(c - a)[part.axis] * float(part.turn), 0); // from outside
        }
    }
    EXPECT_EQ(sides.size(), 6U);
    EXPECT_EQ(triangles, mesh.triangles.size());
}

TEST(FlatParts, OfARoundedSurfaceNoneAndAsThickAsIsAskedFor)
{
    const TriangleMesh sphere = icosphere(1.0, 3);
    EXPECT_TRUE(parts_of(sphere, 1e-6).parts.empty());
    constexpr double kThickness = 0.05;
    const FlatParts thick = parts_of(sphere, kThickness);
    EXPECT_GT(thick.parts.size(), 10U);
    for (std::size_t p = 0; p < thick.parts.size(); ++p) {
        EXPECT_LE(thick.parts[p].thickness, kThickness);
        EXPECT_GT(thick.parts[p].thickness, 0);
        EXPECT_GE(thick.parts[p].triangles.size(), 2U);
        for (const std::uint32_t t : thick.parts[p].triangles)
            EXPECT_EQ(thick.part_of[t], p);
    }
}

TEST(FlatParts, OfATurnedBoxAreItsSidesWithinRounding)
{
    const TriangleMesh mesh = turned(gridded_box({0, 0, 0}, {1, 1, 1}, 8), Vec3d(1, 2, 3), 0.4);
    const FlatParts flat = parts_of(mesh, 1e-5);
    ASSERT_EQ(flat.parts.size(), 6U);
    for (const FlatPart& part : flat.parts) {
        EXPECT_EQ(part.triangles.size(), mesh.triangles.size() / 6);
        EXPECT_LT(part.thickness, 1e-6);
    }
}

/// A box with a point close to the middle of an edge between top and front, in a triangle thinner
/// than anything that counts: on the top's side, or else on the front's.
TriangleMesh box_with_a_cap(bool on_top)
{
    // Corners: 0 to 3 below, 4 to 7 above, counter-clockwise from the origin; front is y = 0.
    TriangleMesh mesh = box({0, 0, 0}, {1, 1, 1});
    std::uint32_t a = 0, b = 0; // the edge, as the triangle of the front runs through it
    std::size_t top = 0, front = 0;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
        for (int k = 0; k < 3; ++k) {
            const std::uint32_t p = mesh.triangles[t][k], q = mesh.triangles[t][(k + 1) % 3];
            const Vec3s &from = mesh.points[p], &to = mesh.points[q];
            if (from[1] + to[1] > 0 || from[2] + to[2] < 2)
                continue;
            const Vec3s& other = mesh.points[mesh.triangles[t][(k + 2) % 3]];
            (other[2] < 1 ? front : top) = t;
            if (other[2] < 1) {
                a = p;
                b = q;
            }
        }
    const auto middle = static_cast<std::uint32_t>(mesh.points.size());
    mesh.points.emplace_back(0.5F, 0.0F, 1.0F);
    mesh.points.back()[on_top ? 1 : 2] += on_top ? 1e-7F : -1e-7F;
    // The thin triangle stands beside the one that is cut in two.
    const std::size_t cut = on_top ? top : front;
    const std::uint32_t from = on_top ? b : a, to = on_top ? a : b;
    std::uint32_t other = 0;
    for (int k = 0; k < 3; ++k)
        if (mesh.triangles[cut][k] != a && mesh.triangles[cut][k] != b)
            other = mesh.triangles[cut][k];
    mesh.triangles[cut] = {from, middle, other};
    mesh.triangles.emplace_back(middle, to, other);
    mesh.triangles.emplace_back(from, to, middle);
    return mesh;
}

TEST(FlatParts, TakeThinTrianglesOnAnEdgeToTheWallBesideTheirLongestSide)
{
    for (const bool on_top : {true, false}) {
        const TriangleMesh mesh = box_with_a_cap(on_top);
        const FlatParts flat = parts_of(mesh, 1e-5);
        ASSERT_EQ(flat.parts.size(), 6U);
        const FlatPart& part = flat.parts[flat.part_of[mesh.triangles.size() - 1]];
        EXPECT_EQ(part.axis, on_top ? 1 : 2); // the front's, and the top's
        EXPECT_EQ(part.triangles.size(), 3U);
    }
}

} // namespace
} // namespace vdb_shell::test
