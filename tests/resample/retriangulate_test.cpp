// SPDX-License-Identifier: Apache-2.0
#include "vdb_shell/resample/retriangulate.h"

#include "vdb_shell/core/error.h"
#include "vdb_shell/pipeline.h"
#include "vdb_shell/resample/surface_distance.h"

#include "resample/neighbours_across.h"
#include "resample/sound.h"
#include "support/cancelled.h"
#include "support/shapes.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>

namespace vdb_shell::test
{
namespace
{

using openvdb::Vec3d;
using openvdb::Vec3I;
using openvdb::Vec3s;

RetriangulateOptions within(double tolerance)
{
    return {true, tolerance};
}

Vec3d normal_of(const TriangleMesh& mesh, const Vec3I& t)
{
    const Vec3d a(mesh.points[t[0]]);
    Vec3d n = (Vec3d(mesh.points[t[1]]) - a).cross(Vec3d(mesh.points[t[2]]) - a);
    n.normalize();
    return n;
}

double angle_at(const TriangleMesh& mesh, std::uint32_t at, std::uint32_t p, std::uint32_t q)
{
    const Vec3d u = Vec3d(mesh.points[p]) - Vec3d(mesh.points[at]);
    const Vec3d v = Vec3d(mesh.points[q]) - Vec3d(mesh.points[at]);
    return std::atan2(u.cross(v).length(), u.dot(v));
}

/// The largest sum of the two angles opposite to an edge inside a flat part. Delaunay: at most pi.
double largest_opposite_angles(const TriangleMesh& mesh)
{
    const auto across = neighbours_across(mesh.triangles);
    double largest = 0;
    for (std::size_t t = 0; t < across.size(); ++t)
        for (int side = 0; side < 3; ++side) {
            const Vec3I &one = mesh.triangles[t], &other = mesh.triangles[across[t][size_t(side)]];
            const Vec3d n = normal_of(mesh, one);
            if (n.dot(normal_of(mesh, other)) < 1 - 1e-9)
                continue;
            const std::uint32_t a = one[side], b = one[(side + 1) % 3], c = one[(side + 2) % 3];
            std::uint32_t d = 0;
            for (int k = 0; k < 3; ++k)
                if (other[k] != a && other[k] != b)
                    d = other[k];
            largest = std::max(largest, angle_at(mesh, c, a, b) + angle_at(mesh, d, a, b));
        }
    return largest;
}

TEST(Retriangulate, OfAPlateOfNeedlesIsDelaunayWithTheSamePointsAndShape)
{
    const TriangleMesh plate = needled_plate(20);
    ASSERT_GT(largest_opposite_angles(plate), M_PI + 0.05);
    const RetriangulateResult result = retriangulate(plate, {true, std::nullopt});
    expect_sound(result.mesh);
    EXPECT_EQ(result.mesh.points, plate.points);
    EXPECT_EQ(result.mesh.triangles.size(), plate.triangles.size());
    EXPECT_LE(largest_opposite_angles(result.mesh), M_PI + 1e-4);
    const auto volume = [](const TriangleMesh& m) { return signed_volume(m.points, m.triangles); };
    EXPECT_NEAR(volume(result.mesh), volume(plate), 1e-9 * volume(plate));
    EXPECT_GT(result.report.shape.mean_min_angle_radians,
              result.report.shape_before.mean_min_angle_radians);
    EXPECT_GT(result.report.flips, 0U);
    EXPECT_EQ(result.report.farthest, 0); // top and bottom are planes, exactly
    EXPECT_EQ(result.report.kept_parts, 0U);
}

TEST(Retriangulate, LeavesASurfaceWithoutFlatPartsBitForBit)
{
    const TriangleMesh sphere = icosphere(1.0, 3);
    const RetriangulateResult result = retriangulate(sphere, {true, std::nullopt});
    EXPECT_EQ(result.mesh.triangles, sphere.triangles);
    EXPECT_EQ(result.report.flat_parts, 0U);
    EXPECT_EQ(result.report.flips, 0U);
}

TEST(Retriangulate, TurnsNoEdgeOfASquareForNothing)
{
    const TriangleMesh grid = gridded_box({0, 0, 0}, {1, 1, 1}, 8);
    const RetriangulateResult result = retriangulate(grid, {true, std::nullopt});
    EXPECT_EQ(result.mesh.triangles, grid.triangles);
    EXPECT_EQ(result.report.flat_parts, 6U);
    EXPECT_EQ(result.report.flat_triangles, grid.triangles.size());
}

TEST(Retriangulate, KeepsAllEdgesAtWhichTheSurfaceTurns)
{
    const TriangleMesh plate = turned(needled_plate(12), Vec3d(1, 2, 3), 0.7);
    const RetriangulateResult result = retriangulate(plate, {true, std::nullopt});
    EXPECT_GT(result.report.flips, 0U);
    const auto sharp = [](const TriangleMesh& mesh) {
        const auto across = neighbours_across(mesh.triangles);
        std::vector<std::array<std::uint32_t, 2>> edges;
        for (std::size_t t = 0; t < across.size(); ++t)
            for (int side = 0; side < 3; ++side) {
                const Vec3I &one = mesh.triangles[t],
                            &other = mesh.triangles[across[t][size_t(side)]];
                if (normal_of(mesh, one).dot(normal_of(mesh, other)) < 1 - 1e-6)
                    edges.push_back({one[side], one[(side + 1) % 3]});
            }
        std::sort(edges.begin(), edges.end());
        return edges;
    };
    EXPECT_EQ(sharp(result.mesh), sharp(plate));
}

TEST(Retriangulate, NeverPartsTheSurfacesByMoreThanTheTolerance)
{
    const TriangleMesh shape = torus(1.0, 0.3, 64, 32);
    std::size_t before = 0;
    for (const double tolerance : {0.003, 0.01, 0.03}) {
        const RetriangulateResult result = retriangulate(shape, within(tolerance));
        expect_sound(result.mesh);
        EXPECT_GE(result.report.flips, before);
        before = result.report.flips;
        EXPECT_LE(result.report.farthest, tolerance);
        EXPECT_LE(surface_distance(shape, result.mesh, 0.01).max, result.report.farthest);
        EXPECT_LE(surface_distance(result.mesh, shape, 0.01).max, result.report.farthest);
    }
    EXPECT_GT(before, 0U);
}

/// A box whose top has its valley turned into a ridge when its long diagonal goes, and a second box
/// above whose tip stands in that valley.
TriangleMesh two_boxes_that_nearly_touch()
{
    TriangleMesh lower;
    // A rhombus, so that its short diagonal makes the better triangles; its ends are the higher
    // corners.
    lower.points = {{-3, 0, -1}, {0, -1, -1},    {3, 0, -1}, {0, 1, -1},
                    {-3, 0, 0},  {0, -1, 0.01F}, {3, 0, 0},  {0, 1, 0.01F}};
    lower.triangles = {{0, 2, 1}, {0, 3, 2}, {4, 5, 6}, {4, 6, 7}};
    for (std::uint32_t i = 0; i < 4; ++i) {
        const std::uint32_t j = (i + 1) % 4;
        lower.triangles.emplace_back(i, j, j + 4);
        lower.triangles.emplace_back(i, j + 4, i + 4);
    }
    TriangleMesh upper;
    upper.points = {{0, 0, 0.005F}, {0.1F, 0, 1}, {-0.05F, 0.1F, 1}, {-0.05F, -0.1F, 1}};
    upper.triangles = {{0, 2, 1}, {0, 3, 2}, {0, 1, 3}, {1, 2, 3}};
    return joined(lower, upper);
}

TEST(Retriangulate, LeavesPartsThatWouldTouchOthers)
{
    const TriangleMesh mesh = two_boxes_that_nearly_touch();
    ASSERT_TRUE(expect_sound(mesh).embedded());
    const RetriangulateResult result = retriangulate(mesh, within(0.1));
    expect_sound(result.mesh);
    EXPECT_EQ(result.report.kept_parts, 1U);
    EXPECT_EQ(result.mesh.triangles[2], mesh.triangles[2]);
    EXPECT_EQ(result.mesh.triangles[3], mesh.triangles[3]);
    // Without the second box, the edge turns.
    TriangleMesh alone = mesh;
    alone.points.resize(8);
    alone.triangles.resize(12);
    const RetriangulateResult turned = retriangulate(alone, within(0.1));
    expect_sound(turned.mesh);
    EXPECT_EQ(turned.report.kept_parts, 0U);
    EXPECT_NE(turned.mesh.triangles[2], mesh.triangles[2]);
    EXPECT_NEAR(turned.report.farthest, 0.01, 0.005);
}

TEST(Retriangulate, FillsMoreBesideNeedles)
{
    ShellOptions options;
    options.coverage.samples = 0;
    options.grow.schedule.restarts.most = 0;
    const TriangleMesh plate = needled_plate(31);
    const ShellResult needles = build_shell(plate, options);
    options.retriangulate.wanted = true;
    const ShellResult turned = build_shell(plate, options);
    ASSERT_TRUE(turned.report.retriangulate);
    EXPECT_TRUE(turned.report.certificate->certified());
    EXPECT_EQ(turned.surface.points, plate.points);
    EXPECT_GT(turned.report.shell_volume, needles.report.shell_volume);
}

TEST(Retriangulate, NeedsASurfaceThatDoesNotCrossItself)
{
    ShellOptions options;
    options.retriangulate.wanted = true;
    options.check.allow_self_intersections = true;
    const TriangleMesh crossing =
        joined(box({0, 0, 0}, {1, 1, 1}), box({0.5, 0.5, 0.5}, {2, 2, 2}));
    EXPECT_THROW(build_shell(crossing, options), GeometryError);
}

TEST(Retriangulate, SameBytesForAnyNumberOfThreads)
{
    const TriangleMesh shape = torus(1.0, 0.3, 64, 32);
    const auto on = [&](std::size_t threads) {
        const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
        return retriangulate(shape, within(0.03)).mesh.triangles;
    };
    EXPECT_EQ(on(1), on(4));
}

TEST(Retriangulate, RefusesAToleranceOfNothing)
{
    for (const double tolerance : {0.0, -1.0})
        EXPECT_THROW(retriangulate(icosphere(1.0, 1), within(tolerance)), InvalidOption);
}

TEST(Retriangulate, CanBeCancelled)
{
    expect_cancelled([](Interrupter* interrupter) {
        retriangulate(needled_plate(20), {true, std::nullopt}, interrupter);
    });
}

} // namespace
} // namespace vdb_shell::test
