// SPDX-License-Identifier: Apache-2.0
#include "vdb_shell/repair/repair_mesh.h"

#include "vdb_shell/core/error.h"

#include "support/faulty_shapes.h"
#include "support/repairs.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <cstring>

namespace vdb_shell::test
{
namespace
{

using openvdb::Vec3d;
using openvdb::Vec3I;
using openvdb::Vec3s;

TEST(RepairHoles, GivesABoxItsLidBack)
{
    for (const int n : {1, 2, 5}) {
        const TriangleMesh open =
            without(gridded_box({0, 0, 0}, {1, 1, 1}, n), [](const Vec3s& p) { return p[2] == 1; });
        const RepairResult result = repair_mesh(open);
        expect_sound(result.report);
        EXPECT_EQ(expect_kept(open, result), open.triangles.size());
        ASSERT_EQ(result.report.holes.size(), 1u);
        EXPECT_EQ(result.report.holes[0].edges, std::size_t(4 * n));
        EXPECT_NEAR(result.report.holes[0].length, 4.0, 1e-6);
        EXPECT_NEAR(signed_volume(result.mesh.points, result.mesh.triangles), 1.0, 1e-6);
        for (std::size_t t = 0; t < result.mesh.triangles.size(); ++t)
            for (int k = 0; k < 3 && result.source_triangle[t] == kNoSource; ++k)
                EXPECT_NEAR(result.mesh.points[result.mesh.triangles[t][k]][2], 1.0, 1e-6);
    }
}

/// A triangle that stands upright, `height` high, with its lower side at (0, 0, `foot`).
TriangleMesh flake(float foot, float height)
{
    TriangleMesh mesh;
    mesh.points = {{-0.05F, 0, foot}, {0.05F, 0, foot}, {0, 0, foot + height}};
    mesh.triangles = {Vec3I(0, 1, 2)};
    return mesh;
}

TEST(RepairHoles, DropsATriangleThatStandsInTheWayOfAFillWhenAsked)
{
    const TriangleMesh open =
        without(icosphere(1.0, 4), [](const Vec3s& p) { return p[2] > 0.85; });
    const auto flake_at = std::uint32_t(open.triangles.size());
    const TriangleMesh mesh = joined(open, flake(0.8F, 0.4F));
    RepairOptions options;
    const RepairReport left = repair_mesh(mesh, options).report;
    EXPECT_EQ(left.loose.first, std::vector<std::uint32_t>{flake_at});
    EXPECT_FALSE(left.loose_dropped);
    EXPECT_EQ(left.holes.size(), 2u);
    EXPECT_EQ(left.kept_triangles, mesh.triangles.size());
    options.drop_loose = true;
    const RepairResult result = repair_mesh(mesh, options);
    expect_sound(result.report);
    EXPECT_EQ(result.report.loose.count, 1u);
    EXPECT_TRUE(result.report.loose_dropped);
    EXPECT_EQ(expect_kept(mesh, result), open.triangles.size());
    ASSERT_EQ(result.report.holes.size(), 1u) << "the flake's is gone, the other filled";
    EXPECT_EQ(result.report.holes[0].method, FillMethod::smooth);
    EXPECT_NE(repair_text(result.report)
                  .find("1 triangles of small open pieces dropped: " + std::to_string(flake_at)),
              std::string::npos);
}

TEST(RepairHoles, DropsATriangleThatHangsOnAPointWhenAsked)
{
    TriangleMesh mesh = icosphere(1.0, 3);
    const auto n = std::uint32_t(mesh.points.size());
    mesh.points.emplace_back(1.2F * mesh.points[5]);
    mesh.points.emplace_back(1.2F * mesh.points[5] + Vec3s(0.03F, 0.02F, 0.01F));
    mesh.triangles.emplace_back(5, n, n + 1);
    RepairOptions options;
    EXPECT_EQ(repair_mesh(mesh, options).report.loose.count, 1u);
    options.drop_loose = true;
    const RepairResult result = repair_mesh(mesh, options);
    expect_sound(result.report);
    EXPECT_EQ(expect_kept(mesh, result), mesh.triangles.size() - 1);
    EXPECT_EQ(result.report.moved_points, 0u) << "there is nobody left to move from";
}

TEST(RepairHoles, DropsNoOpenPieceThatIsLargeNorAnyThatIsClosed)
{
    RepairOptions options;
    options.drop_loose = true;
    // A body of a millionth of the area, and one that a fill closes.
    const TriangleMesh small = translated(box({0, 0, 0}, {1e-3, 1e-3, 1e-3}), {2, 0, 0});
    const TriangleMesh bowl = translated(
        without(icosphere(1e-2, 2), [](const Vec3s& p) { return p[2] > 0.005F; }), {0, 2, 0});
    const TriangleMesh bodies = joined(joined(icosphere(1.0, 3), small), bowl);
    const RepairResult result = repair_mesh(bodies, options);
    expect_sound(result.report);
    EXPECT_EQ(result.report.loose.count, 0u);
    EXPECT_EQ(expect_kept(bodies, result), bodies.triangles.size());
    // A soup of flakes is made of them.
    TriangleMesh soup;
    for (int i = 0; i < 200; ++i)
        soup = joined(soup, translated(flake(0, 0.5F), {double(i), 0, 0}));
    EXPECT_EQ(repair_mesh(soup, options).report.loose.count, 0u);
    // Nobody knows what it is meant to be.
    const TriangleMesh large = joined(icosphere(1.0, 3), translated(flake(0, 6), {3, 0, 0}));
    EXPECT_EQ(repair_mesh(large, options).report.loose.count, 0u);
}

TEST(RepairHoles, ContinuesTheCurvatureOfASphereAcrossAHole)
{
    const TriangleMesh open =
        without(icosphere(1.0, 4), [](const Vec3s& p) { return p[2] > 0.85; });
    const RepairResult result = repair_mesh(open);
    expect_sound(result.report);
    EXPECT_EQ(expect_kept(open, result), open.triangles.size());
    ASSERT_EQ(result.report.holes.size(), 1u);
    EXPECT_EQ(result.report.holes[0].method, FillMethod::smooth);
    EXPECT_GT(result.report.holes[0].new_points, 20u);
    double highest = 0;
    for (std::size_t t = 0; t < result.mesh.triangles.size(); ++t)
        for (int k = 0; k < 3 && result.source_triangle[t] == kNoSource; ++k) {
            const Vec3d p(result.mesh.points[result.mesh.triangles[t][k]]);
            // Chords of the rim lie inside the ball; a flat lid would reach down to 0.85 there.
            EXPECT_GT(p.length(), 0.93);
            EXPECT_LT(p.length(), 1.07);
            highest = std::max(highest, p[2]);
        }
    EXPECT_GT(highest, 0.93) << "the fill is flat";
}

TEST(RepairHoles, ClosesEveryHoleOfAManyHoledSphere)
{
    const TriangleMesh whole = icosphere(1.0, 3);
    TriangleMesh open = whole;
    open.triangles.clear();
    // Every twentieth triangle is missing: holes of three edges, some of which meet in points.
    for (std::size_t t = 0; t < whole.triangles.size(); ++t)
        if (t % 20 != 0)
            open.triangles.push_back(whole.triangles[t]);
    const RepairResult result = repair_mesh(open);
    expect_sound(result.report);
    EXPECT_EQ(result.mesh.points.size(), whole.points.size());
    EXPECT_EQ(result.mesh.triangles.size(), whole.triangles.size());
    EXPECT_NEAR(signed_volume(result.mesh.points, result.mesh.triangles),
                signed_volume(whole.points, whole.triangles), 1e-9);
}

TEST(RepairHoles, HolesThatMeetInAPointAreClosedWithoutACopy)
{
    // Two opposite triangles at one point are missing.
    const TriangleMesh whole = icosphere(1.0, 2);
    std::vector<std::size_t> around;
    const std::uint32_t v = whole.triangles[0][0];
    for (std::size_t t = 0; t < whole.triangles.size(); ++t)
        for (int k = 0; k < 3; ++k)
            if (whole.triangles[t][k] == v)
                around.push_back(t);
    const auto shared = [&](std::size_t a, std::size_t b) {
        int count = 0;
        for (int i = 0; i < 3; ++i)
            for (int j = 0; j < 3; ++j)
                count += whole.triangles[a][i] == whole.triangles[b][j];
        return count;
    };
    const std::size_t first = around.front();
    const std::size_t second = *std::find_if(around.begin(), around.end(),
                                             [&](std::size_t t) { return shared(first, t) == 1; });
    TriangleMesh open =
        without_triangle(without_triangle(whole, std::max(first, second)), std::min(first, second));
    ASSERT_EQ(check_mesh(open).non_manifold_vertices.count, 1u);
    const RepairResult result = repair_mesh(open);
    expect_sound(result.report);
    EXPECT_EQ(result.report.copies, 0u);
    EXPECT_EQ(result.mesh.points.size(), whole.points.size());
    EXPECT_EQ(result.report.holes.size(), 2u);
}

TEST(RepairHoles, ClosesRimsOfMoreThanAThousandEdges)
{
    // A drum without its lid, and one of a star's shape, whose rim has reflex corners.
    for (const double wave : {0.0, 0.2}) {
        std::vector<openvdb::Vec2d> rim;
        constexpr int kCorners = 1500;
        for (int i = 0; i < kCorners; ++i) {
            const double u = 2 * M_PI * i / kCorners, r = 1 + wave * std::cos(5 * u);
            rim.emplace_back(r * std::cos(u), r * std::sin(u));
        }
        const TriangleMesh drum = test::extruded(rim, {0.0, 1.0});
        const double whole = signed_volume(drum.points, drum.triangles);
        const auto last = static_cast<std::uint32_t>(drum.points.size() - 1);
        TriangleMesh open = drum;
        open.triangles.clear();
        for (const openvdb::Vec3I& t : drum.triangles)
            if (t[0] != last && t[1] != last && t[2] != last)
                open.triangles.push_back(t);
        open.points.pop_back();
        const RepairResult result = repair_mesh(open);
        test::expect_sound(result.report);
        ASSERT_EQ(result.report.holes.size(), 1u);
        EXPECT_EQ(result.report.holes[0].edges, std::size_t(kCorners));
        EXPECT_EQ(result.report.holes[0].new_triangles, std::size_t(kCorners - 2));
        EXPECT_EQ(test::expect_kept(open, result), open.triangles.size());
        EXPECT_NEAR(signed_volume(result.mesh.points, result.mesh.triangles), whole, 1e-5);
    }
}

TEST(RepairHoles, LeavesOneSidedSurfacesAsTheyAre)
{
    const TriangleMesh strip = moebius_strip(24, 3);
    RepairResult result = repair_mesh(strip);
    EXPECT_EQ(expect_kept(strip, result), strip.triangles.size());
    ASSERT_EQ(result.report.holes.size(), 1u);
    EXPECT_EQ(result.report.holes[0].method, FillMethod::none);
    EXPECT_EQ(result.report.holes[0].edges, 48u);
    EXPECT_FALSE(result.report.after.closed());
    EXPECT_GT(result.report.after.inconsistent_edges.count, 0u);
    EXPECT_THROW(require_usable(result.report.after, {}, "strip"), GeometryError);

    const TriangleMesh bottle = klein_bottle(24, 16);
    result = repair_mesh(bottle);
    EXPECT_TRUE(result.report.after.closed());
    EXPECT_GT(result.report.after.inconsistent_edges.count, 0u);
}

TEST(RepairHoles, LeavesAFlatSheetOpenUnlessCrossingsAreWanted)
{
    TriangleMesh sheet = without(gridded_box({0, 0, 0}, {1, 1, 1}, 3),
                                 [](const Vec3s& p) { return p[0] == 0 || p[0] == 1; });
    sheet.triangles.erase(std::remove_if(sheet.triangles.begin(), sheet.triangles.end(),
                                         [&](const Vec3I& t) {
                                             return sheet.points[t[0]][2] < 1 ||
                                                    sheet.points[t[1]][2] < 1 ||
                                                    sheet.points[t[2]][2] < 1;
                                         }),
                          sheet.triangles.end());
    RepairResult result = repair_mesh(sheet);
    ASSERT_EQ(result.report.holes.size(), 1u);
    EXPECT_EQ(result.report.holes[0].method, FillMethod::none);
    EXPECT_GT(result.report.holes[0].crossings, 0u);
    RepairOptions options;
    options.keep_crossing_fills = true;
    result = repair_mesh(sheet, options);
    EXPECT_NE(result.report.holes[0].method, FillMethod::none);
    EXPECT_TRUE(result.report.after.closed());
}

TEST(RepairHoles, DoesNotCrossWhatStandsInTheHole)
{
    // A spike stands in the open top of a box, so the flat lid, the first choice, would cross it.
    const TriangleMesh open =
        without(gridded_box({0, 0, 0}, {1, 1, 1}, 4), [](const Vec3s& p) { return p[2] == 1; });
    TriangleMesh spike = unit_tetrahedron();
    for (Vec3s& p : spike.points)
        p = Vec3s(0.05f * p[0] + 0.4f, 0.05f * p[1] + 0.4f, 0.8f * p[2] + 0.5f);
    const RepairResult result = repair_mesh(joined(open, spike));
    ASSERT_EQ(result.report.holes.size(), 1u);
    // A closed fill cannot help crossing the spike when it goes round neither end; whichever way,
    // what is kept crosses nothing.
    EXPECT_EQ(result.report.after.self_intersections.count, 0u);
    EXPECT_EQ(result.report.holes[0].method == FillMethod::none,
              result.report.holes[0].crossings > 0);
}

TEST(RepairHoles, SameBytesForAnyNumberOfThreads)
{
    const TriangleMesh open =
        without(icosphere(1.0, 4), [](const Vec3s& p) { return std::abs(p[2]) > 0.8; });
    std::vector<RepairResult> results;
    for (const std::size_t threads : {1, 4}) {
        tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
        results.push_back(repair_mesh(open));
    }
    EXPECT_EQ(results[0].mesh.triangles, results[1].mesh.triangles);
    ASSERT_EQ(results[0].mesh.points.size(), results[1].mesh.points.size());
    EXPECT_EQ(std::memcmp(results[0].mesh.points.data(), results[1].mesh.points.data(),
                          results[0].mesh.points.size() * sizeof(Vec3s)),
              0);
    EXPECT_EQ(repair_json(results[0].report), repair_json(results[1].report));
}

} // namespace
} // namespace vdb_shell::test
