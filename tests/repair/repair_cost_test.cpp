// SPDX-License-Identifier: Apache-2.0
#include "vdb_shell/repair/repair_mesh.h"

#include "vdb_shell/core/error.h"

#include "support/repairs.h"
#include "support/shapes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

namespace vdb_shell::test
{
namespace
{

using openvdb::Vec3d;
using openvdb::Vec3I;
using openvdb::Vec3s;

/// All faces of a grid of cubes that are cut into six tets each, every face once.
TriangleMesh faces_of_tets(std::uint32_t cells)
{
    TriangleMesh mesh;
    const std::uint32_t side = cells + 1;
    for (std::uint32_t i = 0; i < side * side * side; ++i)
        mesh.points.emplace_back(float(i % side), float(i / side % side), float(i / side / side));
    const std::array<std::uint32_t, 3> step{1, side, side * side};
    std::set<std::array<std::uint32_t, 3>> seen;
    for (std::uint32_t i = 0; i < cells * cells * cells; ++i) {
        const std::uint32_t a =
            i % cells + side * (i / cells % cells) + side * side * (i / cells / cells);
        for (std::size_t x = 0; x < 3; ++x)
            for (const std::size_t y : {(x + 1) % 3, (x + 2) % 3}) {
                const std::array<std::uint32_t, 4> tet{a, a + step[x], a + step[x] + step[y],
                                                       a + 1 + side + side * side};
                for (std::size_t left_out = 0; left_out < 4; ++left_out) {
                    std::array<std::uint32_t, 3> face{};
                    for (std::size_t k = 0, n = 0; k < 4; ++k)
                        if (k != left_out)
                            face[n++] = tet[k];
                    if (seen.insert(face).second)
                        mesh.triangles.emplace_back(face[0], face[1], face[2]);
                }
            }
    }
    return mesh;
}

// Each of these surfaces takes a second or two; in time that grows with the square it would be
// minutes to hours, of which CTest's limit for a test allows ten minutes.

TEST(RepairCost, FacesOfATetMeshEnd)
{
    const TriangleMesh mesh = faces_of_tets(12);
    ASSERT_GT(mesh.triangles.size(), 20000u);
    const RepairResult result = repair_mesh(mesh);
    EXPECT_GT(expect_kept(mesh, result), 0u);
    EXPECT_EQ(result.report.after.non_manifold_edges.count, 0u);
}

TEST(RepairCost, CrossingsOfAFillAreCountedToAThousand)
{
    // Pages of one edge: each page's fill touches all others.
    TriangleMesh mesh;
    mesh.points = {Vec3s(0, 0, 0), Vec3s(0, 0, 1)};
    for (std::uint32_t i = 0; i < 1500; ++i) {
        const double angle = 2 * M_PI * i / 1500;
        mesh.points.emplace_back(float(std::cos(angle)), float(std::sin(angle)), 0.5F);
        mesh.triangles.emplace_back(0, 1, i + 2);
    }
    const std::vector<HoleFill> holes = repair_mesh(mesh, {}).report.holes;
    EXPECT_GT(holes.size(), 1000u);
    for (const HoleFill& hole : holes) {
        EXPECT_LE(hole.crossings, HoleFill::kMostCounted);
        EXPECT_EQ(hole.crossings_at_least, hole.crossings == HoleFill::kMostCounted);
    }
    EXPECT_TRUE(std::any_of(holes.begin(), holes.end(), [](const HoleFill& hole) {
        return hole.crossings == HoleFill::kMostCounted;
    }));
}

TEST(RepairCost, ThousandsOfCopiesOfATriangle)
{
    TriangleMesh mesh = box({0, 0, 0}, {1, 1, 1});
    mesh.triangles.resize(mesh.triangles.size() + 60000, mesh.triangles[0]);
    EXPECT_EQ(check_mesh(mesh).duplicate_triangles.count, 60000u);
    const RepairResult result = repair_mesh(mesh);
    EXPECT_EQ(result.report.duplicates.count, 60000u);
    EXPECT_EQ(signed_volume(result.mesh.points, result.mesh.triangles), 1.0);
}

TEST(RepairCost, ThousandsOfHoles)
{
    TriangleMesh mesh = icosphere(1.0, 5);
    const double whole = signed_volume(mesh.points, mesh.triangles);
    std::size_t kept = 0;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
        if (t % 8 != 5)
            mesh.triangles[kept++] = mesh.triangles[t];
    mesh.triangles.resize(kept);
    const RepairResult result = repair_mesh(mesh);
    EXPECT_EQ(expect_kept(mesh, result), kept);
    EXPECT_GT(result.report.holes.size(), 1000u);
    // Each hole is at most a few triangles wide, so a fill is off by no more than their bulge.
    EXPECT_NEAR(signed_volume(result.mesh.points, result.mesh.triangles), whole, 0.01 * whole);
}

TEST(RepairCost, APointOfThousandsOfTriangles)
{
    constexpr std::uint32_t kRim = 2000;
    TriangleMesh mesh;
    for (std::uint32_t i = 0; i < kRim; ++i)
        mesh.points.emplace_back(float(std::cos(2 * M_PI * i / kRim)),
                                 float(std::sin(2 * M_PI * i / kRim)), 0.f);
    mesh.points.emplace_back(0.f, 0.f, 1.f);
    mesh.points.emplace_back(0.f, 0.f, -1.f);
    for (std::uint32_t i = 0; i < kRim; ++i) {
        mesh.triangles.emplace_back(i, (i + 1) % kRim, kRim);
        mesh.triangles.emplace_back((i + 1) % kRim, i, kRim + 1);
    }
    EXPECT_EQ(check_mesh(mesh).self_intersections.count, 0u);
}

TEST(RepairCost, AWeldThatIsFinerThanNumbersAre)
{
    // Coordinates in units of the tolerance are far beyond the integers.
    TriangleMesh mesh = translated(icosphere(1.0, 1), {1e6, 0, 0});
    for (Vec3s& point : mesh.points)
        point *= 1e6f;
    RepairOptions options;
    options.weld_tolerance = 1e-30;
    const RepairResult fine = repair_mesh(mesh, options), exact = repair_mesh(mesh);
    EXPECT_EQ(fine.report.welded_points.count, exact.report.welded_points.count);
}

TEST(RepairCost, AnObjectOfAThousandthIsMendedAsALargeOneIs)
{
    // A power of two: coordinates scale without rounding, and so does all that is decided.
    TriangleMesh large = icosphere(1.0, 3), small = large;
    for (TriangleMesh* mesh : {&large, &small}) {
        const Vec3s top = mesh->points[0];
        std::vector<Vec3I> rest;
        for (const Vec3I& t : mesh->triangles)
            if ((mesh->points[t[0]] - top).length() > 0.4f)
                rest.push_back(t);
        mesh->triangles = rest;
    }
    const float scale = std::ldexp(1.f, -13);
    for (Vec3s& point : small.points)
        point *= scale;
    const RepairResult a = repair_mesh(large), b = repair_mesh(small);
    ASSERT_EQ(a.report.holes.size(), b.report.holes.size());
    EXPECT_EQ(a.report.holes[0].method, b.report.holes[0].method);
    ASSERT_EQ(a.mesh.triangles, b.mesh.triangles);
    for (std::size_t v = 0; v < a.mesh.points.size(); ++v)
        EXPECT_NEAR((Vec3d(b.mesh.points[v]) / double(scale) - Vec3d(a.mesh.points[v])).length(), 0,
                    1e-5);
}

/// Stops at the n-th question.
struct StopsLater : openvdb::util::NullInterrupter {
    explicit StopsLater(int questions) : left(questions) {}
    bool wasInterrupted(int) override { return --left < 0; }
    int left;
};

TEST(RepairCost, AnInterruptIsHeardInTheCheck)
{
    const TriangleMesh mesh = icosphere(1.0, 5);
    StopsLater now(0);
    EXPECT_THROW(check_mesh(mesh, &now), Cancelled);
    StopsLater later(1);
    EXPECT_THROW(check_mesh(mesh, &later), Cancelled);
}

} // namespace
} // namespace vdb_shell::test
