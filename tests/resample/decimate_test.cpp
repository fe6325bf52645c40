// SPDX-License-Identifier: Apache-2.0
#include "vdb_shell/resample/decimate.h"

#include "vdb_shell/core/error.h"
#include "vdb_shell/mesh/check_mesh.h"

#include "resample/sound.h"
#include "support/cancelled.h"
#include "support/shapes.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <limits>
#include <string>

namespace vdb_shell::test
{
namespace
{

TEST(Decimate, ReachesTheNumberAndMeasuresBothWays)
{
    const TriangleMesh sphere = icosphere(1.0, 4); // 5120 triangles
    const DecimateResult result = decimate(sphere, {2000, std::nullopt});
    expect_sound(result.mesh);
    EXPECT_TRUE(result.report.reached());
    EXPECT_EQ(result.report.before, 5120U);
    EXPECT_EQ(result.report.triangles, result.mesh.triangles.size());
    EXPECT_GE(result.mesh.triangles.size(), 1990U); // and no further
    const DistanceFigures out = surface_distance(sphere, result.mesh, 0.02);
    const DistanceFigures back = surface_distance(result.mesh, sphere, 0.02);
    EXPECT_NEAR(result.report.input_to_result.max, out.max, 0.1 * out.max);
    EXPECT_NEAR(result.report.result_to_input.max, back.max, 0.1 * back.max);
    // 2000 triangles of edge about 0.12: the sagitta is about e^2 / 6.
    EXPECT_LT(out.max, 0.02);
}

TEST(Decimate, NeverExceedsTheToleranceAndReportsWhatCannotBeHad)
{
    const TriangleMesh shape = torus(1.0, 0.3, 64, 32); // 4096 triangles
    std::size_t last = shape.triangles.size();
    for (const double tolerance : {0.002, 0.01, 0.05}) {
        const DecimateResult result = decimate(shape, {50, tolerance});
        expect_sound(result.mesh);
        EXPECT_LE(surface_distance(shape, result.mesh, 0.01).max, 1.05 * tolerance);
        EXPECT_LE(surface_distance(result.mesh, shape, 0.01).max, 1.05 * tolerance);
        EXPECT_LE(result.report.input_to_result.max, tolerance);
        EXPECT_LE(result.report.result_to_input.max, tolerance);
        EXPECT_FALSE(result.report.reached());
        EXPECT_EQ(result.report.wanted, 50U);
        EXPECT_LT(result.mesh.triangles.size(), last); // more tolerance, fewer triangles
        last = result.mesh.triangles.size();
    }
}

TEST(Decimate, OfAFlatGridCostsNothing)
{
    const TriangleMesh grid = gridded_box({0, 0, 0}, {1, 1, 1}, 6);
    const DecimateResult result = decimate(grid, {100, 1e-6});
    expect_sound(result.mesh);
    EXPECT_LE(result.mesh.triangles.size(), grid.triangles.size() / 2);
    EXPECT_NEAR(signed_volume(result.mesh.points, result.mesh.triangles), 1.0, 1e-6);
}

TEST(Decimate, ToMoreThanThereAreChangesNothing)
{
    const TriangleMesh mesh = icosphere(1.0, 1);
    const DecimateResult result = decimate(mesh, {1000, std::nullopt});
    EXPECT_EQ(result.mesh.points, mesh.points);
    EXPECT_EQ(result.mesh.triangles.size(), mesh.triangles.size());
    EXPECT_LT(result.report.input_to_result.max, 1e-12);
    EXPECT_TRUE(result.report.reached());
}

TEST(Decimate, SameBytesForAnyNumberOfThreads)
{
    const TriangleMesh shape = torus(1.0, 0.3, 32, 16);
    const TriangleMesh many = decimate(shape, {500, 0.02}).mesh;
    const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
    const TriangleMesh single = decimate(shape, {500, 0.02}).mesh;
    EXPECT_EQ(many.points, single.points);
    EXPECT_EQ(many.triangles, single.triangles);
}

TEST(Decimate, RefusesOptionsByName)
{
    const auto message = [](const DecimateOptions& options) -> std::string {
        try {
            decimate(icosphere(1.0, 1), options);
        } catch (const InvalidOption& error) {
            return error.what();
        }
        return "";
    };
    EXPECT_NE(message({3, std::nullopt}).find("triangles is 3"), std::string::npos);
    for (const double bad : {0.0, -1.0, std::numeric_limits<double>::quiet_NaN()})
        EXPECT_NE(message({100, bad}).find("tolerance is"), std::string::npos);
}

TEST(Decimate, CanBeCancelled)
{
    const TriangleMesh sphere = icosphere(1.0, 2);
    expect_cancelled([&](Interrupter* interrupter) {
        decimate(sphere, {100, std::nullopt}, interrupter);
    });
}

} // namespace
} // namespace vdb_shell::test
