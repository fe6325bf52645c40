// SPDX-License-Identifier: Apache-2.0
#include "vdb_shell/resample/refine_triangles.h"

#include "vdb_shell/mesh/check_mesh.h"
#include "vdb_shell/resample/subdivide.h"

#include "support/shapes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace vdb_shell::test
{
namespace
{

constexpr std::size_t kNoLimit = std::numeric_limits<std::size_t>::max();

double smallest_angle(const TriangleMesh& mesh)
{
    double smallest = 4;
    for (const openvdb::Vec3I& t : mesh.triangles)
        for (int k = 0; k < 3; ++k) {
            const openvdb::Vec3d a(mesh.points[t[k]]), b(mesh.points[t[(k + 1) % 3]]),
                c(mesh.points[t[(k + 2) % 3]]);
            smallest =
                std::min(smallest, std::atan2((b - a).cross(c - a).length(), (b - a).dot(c - a)));
        }
    return smallest;
}

void expect_conforming(const TriangleMesh& mesh, double volume)
{
    const MeshCheck check = check_mesh(mesh);
    EXPECT_TRUE(check.closed() && check.manifold() && check.embedded());
    EXPECT_EQ(check.inconsistent_edges.count + check.degenerate_triangles.count, 0U);
    EXPECT_NEAR(check.volume, volume, 1e-6 * std::abs(volume));
}

TEST(RefineTriangles, CutsTheWantedInFourAndConforms)
{
    const TriangleMesh mesh = torus(1.0, 0.3, 16, 8);
    const double volume = signed_volume(mesh.points, mesh.triangles);
    const std::vector<std::uint32_t> wanted{7, 100, 31};
    const RefinedMesh refined = refine_triangles(mesh, wanted, kNoLimit);
    expect_conforming(refined.mesh, volume);
    EXPECT_EQ(refined.cut, 3U);
    EXPECT_EQ(refined.barred_edges, 0U);
    for (const std::uint32_t t : wanted)
        EXPECT_EQ(std::count(refined.source.begin(), refined.source.end(), t), 4);
    // Each middle cuts a piece on both sides of its edge.
    EXPECT_EQ(refined.mesh.triangles.size(), mesh.triangles.size() + 2 * refined.halved.size());
    EXPECT_EQ(refined.mesh.points.size(), mesh.points.size() + refined.halved.size());
    EXPECT_LT(refined.mesh.triangles.size(), 2 * mesh.triangles.size());
    for (std::size_t i = 0; i < refined.halved.size(); ++i) {
        const auto [a, b] = refined.halved[i];
        const openvdb::Vec3d middle =
            0.5 * (openvdb::Vec3d(mesh.points[a]) + openvdb::Vec3d(mesh.points[b]));
        EXPECT_EQ(refined.mesh.points[mesh.points.size() + i], openvdb::Vec3s(middle));
    }
}

TEST(RefineTriangles, OfAllIsUniformSubdivision)
{
    const TriangleMesh mesh = icosphere(1.0, 1);
    std::vector<std::uint32_t> all(mesh.triangles.size());
    std::iota(all.begin(), all.end(), 0U);
    const TriangleMesh refined = refine_triangles(mesh, all, kNoLimit).mesh;
    EXPECT_EQ(refined.points, subdivide(mesh, {1}).points);
    EXPECT_EQ(refined.triangles.size(), 4 * mesh.triangles.size());
}

TEST(RefineTriangles, RoundAfterRoundInOnePlaceKeepsAngles)
{
    TriangleMesh mesh = gridded_box({0, 0, 0}, {1, 1, 1}, 3);
    const double before = smallest_angle(mesh);
    for (int round = 0; round < 8; ++round) {
        mesh = refine_triangles(mesh, {0}, kNoLimit).mesh;
        expect_conforming(mesh, 1.0);
    }
    EXPECT_GE(smallest_angle(mesh), 0.5 * before - 1e-6);
    EXPECT_LT(mesh.triangles.size(), 1000U); // what spreads stays near
}

TEST(RefineTriangles, KeepsWithinTheRoomGiven)
{
    const TriangleMesh mesh = torus(1.0, 0.3, 16, 8);
    std::vector<std::uint32_t> all(mesh.triangles.size());
    std::iota(all.begin(), all.end(), 0U);
    for (const std::size_t most : {mesh.triangles.size(), std::size_t(300), std::size_t(511)}) {
        const RefinedMesh refined = refine_triangles(mesh, all, most);
        EXPECT_LE(refined.mesh.triangles.size(), most);
        EXPECT_TRUE(refined.out_of_room);
        EXPECT_LT(refined.cut, all.size());
    }
    EXPECT_FALSE(refine_triangles(mesh, {}, 1).out_of_room);
}

TEST(RefineTriangles, LeavesWholeWhatRoundingWouldSpoil)
{
    // The corners of the small tetrahedron are single steps of float32 apart: no middle between.
    const float one = 1.0F, next = std::nextafter(1.0F, 2.0F);
    const TriangleMesh tiny{{{one, one, one}, {next, one, one}, {one, next, one}, {one, one, next}},
                            {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}};
    ASSERT_TRUE(check_mesh(tiny).embedded());
    const RefinedMesh refined = refine_triangles(tiny, {0, 1, 2, 3}, kNoLimit);
    const MeshCheck check = check_mesh(refined.mesh);
    EXPECT_TRUE(check.closed() && check.manifold() && check.embedded());
    EXPECT_EQ(check.degenerate_triangles.count, 0U);
    EXPECT_GT(refined.barred_edges, 0U);
    // Plain subdivision does spoil it, and check_mesh tells.
    const MeshCheck spoiled = check_mesh(subdivide(tiny, {1}));
    EXPECT_GT(spoiled.degenerate_triangles.count + spoiled.self_intersections.count, 0U);
}

} // namespace
} // namespace vdb_shell::test
