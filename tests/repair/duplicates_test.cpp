// SPDX-License-Identifier: Apache-2.0
#include "vdb_shell/repair/repair_mesh.h"

#include "support/repairs.h"
#include "support/shapes.h"

#include <gtest/gtest.h>

namespace vdb_shell::test
{
namespace
{

double volume_of(const RepairResult& result)
{
    return signed_volume(result.mesh.points, result.mesh.triangles);
}

/// Each triangle `times` times more; the copies turned round or not.
TriangleMesh repeated(const TriangleMesh& mesh, int times, bool turned)
{
    TriangleMesh all = mesh;
    const TriangleMesh copy = turned ? reversed(mesh) : mesh;
    for (int i = 0; i < times; ++i)
        all.triangles.insert(all.triangles.end(), copy.triangles.begin(), copy.triangles.end());
    return all;
}

TEST(Duplicates, ABodyWhoseFacesAreAllRepeatedKeepsOneOfEach)
{
    for (const bool turned : {false, true})
        for (const int times : {1, 2, 3}) {
            const RepairResult result =
                repair_mesh(repeated(box({0, 0, 0}, {1, 1, 1}), times, turned));
            expect_sound(result.report);
            EXPECT_EQ(result.report.duplicates.count, 12u * unsigned(times));
            EXPECT_DOUBLE_EQ(volume_of(result), 1.0) << turned << times;
        }
}

TEST(Duplicates, ABodyWhosePointsAreDoubledTooIsKept)
{
    const TriangleMesh one = icosphere(1.0, 2);
    const RepairResult result = repair_mesh(joined(one, reversed(one)));
    expect_sound(result.report);
    EXPECT_EQ(result.mesh.triangles.size(), one.triangles.size());
}

TEST(Duplicates, TwoSidesOfASurfaceWithAHoleLeaveOneToBeClosed)
{
    const TriangleMesh open = without_triangle(icosphere(1.0, 2), 7);
    const RepairResult result = repair_mesh(repeated(open, 1, true));
    expect_sound(result.report);
    EXPECT_EQ(result.report.holes.size(), 1u);
}

TEST(Duplicates, AnInterfaceWithinASolidGoesAndACavitySkinOfOneSideStays)
{
    const TriangleMesh outer = box({0, 0, 0}, {4, 4, 4}), inner = box({1, 1, 1}, {2, 2, 2});
    // The inner body and the cavity that it fills.
    RepairResult result = repair_mesh(joined(outer, joined(reversed(inner), inner)));
    expect_sound(result.report);
    EXPECT_DOUBLE_EQ(volume_of(result), 64.0);
    // Copies that do not cancel are those of one surface.
    result = repair_mesh(joined(outer, joined(inner, inner)));
    expect_sound(result.report);
    EXPECT_DOUBLE_EQ(volume_of(result), 63.0);
}

TEST(Duplicates, AScrapOfTwoSidesAndAFinOfTwoSidesGo)
{
    TriangleMesh mesh = icosphere(1.0, 2);
    const auto next = static_cast<std::uint32_t>(mesh.points.size());
    mesh.points.insert(mesh.points.end(), {{3, 0, 0}, {4, 0, 0}, {3, 1, 0}});
    mesh.triangles.emplace_back(next, next + 1, next + 2);
    mesh.triangles.emplace_back(next, next + 2, next + 1);
    const openvdb::Vec3I at = mesh.triangles[0];
    mesh.triangles.emplace_back(at[0], at[1], next);
    mesh.triangles.emplace_back(at[1], at[0], next);
    const RepairResult result = repair_mesh(mesh);
    expect_sound(result.report);
    EXPECT_EQ(result.report.duplicates.count, 4u);
    EXPECT_EQ(result.mesh.triangles.size(), 320u);
}

} // namespace
} // namespace vdb_shell::test
