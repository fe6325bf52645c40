// SPDX-License-Identifier: Apache-2.0
#include "vdb_shell/obstacles/core_feet.h"

#include "core/grid_instances.h"
#include "mesh/nearest_on_triangle.h"
#include "support/cores.h"
#include "support/files.h"
#include "support/shapes.h"
#include "vdb_shell/pipeline.h"
#include "vdb_shell/write/vdb_file.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

// Where pillars ended on cores, held against a search through all triangles.

namespace
{

using namespace vdb_shell;
using openvdb::Vec3d;
using openvdb::Vec3I;
using openvdb::Vec3s;
using test::ball;

ShellResult capsule_with_bones(double distance = 0)
{
    ShellOptions options;
    options.level_set.resolution = 64;
    options.cores.distance = distance;
    return build_shell(test::capsule(), options, "capsule", nullptr, nullptr,
                       {ball(0.4, Vec3d(0, 0, 1.2)), ball(0.3, Vec3d(0.1, 0, -1))});
}

double brute_distance(const std::vector<CoreMesh>& cores, const Vec3d& point)
{
    double least = std::numeric_limits<double>::infinity();
    for (const CoreMesh& core : cores)
        for (const Vec3I& t : core.mesh.triangles)
            least = std::min(least, (nearest_on_triangle({Vec3d(core.mesh.points[t[0]]),
                                                          Vec3d(core.mesh.points[t[1]]),
                                                          Vec3d(core.mesh.points[t[2]])},
                                                         point)
                                         .point -
                                     point)
                                        .length());
    return least;
}

Vec3d place_of(const std::vector<CoreMesh>& cores, const CoreFoot& foot)
{
    const TriangleMesh& mesh = cores[std::size_t(foot.core)].mesh;
    const Vec3I& t = mesh.triangles[std::size_t(foot.triangle)];
    return double(foot.uvw[0]) * Vec3d(mesh.points[t[0]]) +
           double(foot.uvw[1]) * Vec3d(mesh.points[t[1]]) +
           double(foot.uvw[2]) * Vec3d(mesh.points[t[2]]);
}

TEST(CoreFeet, AreTheNearestPoints)
{
    for (const double distance : {0.0, 0.1}) {
        SCOPED_TRACE(distance);
        const ShellResult result = capsule_with_bones(distance);
        const std::vector<Vec3s>& inner = result.stack.surface(1);
        std::size_t ended = 0;
        for (std::size_t v = 0; v < inner.size(); ++v) {
            const CoreFoot& foot = result.core_feet[v];
            const double least = brute_distance(result.cores->given, Vec3d(inner[v]));
            EXPECT_NEAR(foot.distance, least, 1e-6) << v;
            EXPECT_GE(least, distance);
            if (foot.core < 0) {
                EXPECT_EQ(foot.triangle, -1);
                EXPECT_EQ(foot.uvw, Vec3s(0.0f));
                continue;
            }
            ++ended;
            EXPECT_NEAR((place_of(result.cores->given, foot) - Vec3d(inner[v])).length(), least,
                        1e-6)
                << v;
            EXPECT_NEAR(foot.uvw[0] + foot.uvw[1] + foot.uvw[2], 1, 1e-6);
        }
        EXPECT_GT(ended, 300U);
        EXPECT_EQ(ended, result.report.cores->ended);
        EXPECT_EQ(ended, result.report.cores->cores[0].ended + result.report.cores->cores[1].ended);
    }
}

TEST(CoreFeet, WhatThicknessEndsDidNotEndAtACore)
{
    ShellOptions options;
    options.level_set.resolution = 64;
    options.line_step.thickness = 0.1;
    const ShellResult result =
        build_shell(test::icosphere(1, 3), options, "sphere", nullptr, nullptr, {ball(0.5)});
    EXPECT_EQ(result.report.cores->ended, 0U);
    EXPECT_GT(result.report.cores->least_distance, 0.39);
    for (const CoreFoot& foot : result.core_feet)
        EXPECT_GT(foot.distance, 0.39f);
}

TEST(CoreFeet, EndAtTheCoreThatTheyReach)
{
    const ShellResult result = capsule_with_bones();
    for (std::size_t v = 0; v < result.core_feet.size(); ++v)
        if (const CoreFoot& foot = result.core_feet[v]; foot.core >= 0) {
            EXPECT_EQ(foot.core, result.stack.surface(1)[v][2] > 0 ? 0 : 1) << v;
        }
}

TEST(CoreFeet, AreTheReasonWhyThosePillarsEnd)
{
    ShellOptions options;
    options.level_set.resolution = 64;
    options.layers.layers = 2;
    const ShellResult result =
        build_shell(test::capsule(), options, "capsule", nullptr, nullptr,
                    {ball(0.4, Vec3d(0, 0, 1.2)), ball(0.3, Vec3d(0.1, 0, -1))});
    std::size_t ended = 0;
    for (std::size_t v = 0; v < result.core_feet.size(); ++v)
        for (const PrismShell& layer : result.stack.layers) {
            EXPECT_EQ(layer.stop[v] == StopReason::core, result.core_feet[v].core >= 0) << v;
            ended += layer.stop[v] == StopReason::core;
        }
    EXPECT_EQ(ended, 2 * result.report.cores->ended);
    EXPECT_EQ(result.report.lines.stops[std::size_t(StopReason::core)], result.report.cores->ended);
    EXPECT_GT(ended, 600U);
}

TEST(CoreFeet, AllOfAnEvenShellEndsThere)
{
    ShellOptions options;
    options.level_set.resolution = 64;
    const ShellResult result =
        build_shell(test::icosphere(1, 3), options, "sphere", nullptr, nullptr, {ball(0.5)});
    EXPECT_EQ(result.report.cores->ended, result.surface.points.size());
}

TEST(CoreFeet, TetPointsHaveThoseOfTheirPillars)
{
    const ShellResult result = capsule_with_bones();
    const auto feet = feet_of_tet_points(result.stack, result.tets, result.core_feet);
    ASSERT_EQ(feet.size(), result.tets.points.size());
    for (std::size_t i = 0; i < feet.size(); ++i) {
        const CoreFoot expected =
            result.tets.layer[i] == 1 ? result.core_feet[result.tets.source_vertex[i]] : CoreFoot{};
        EXPECT_EQ(feet[i].core, expected.core);
        EXPECT_EQ(feet[i].triangle, expected.triangle);
    }
    EXPECT_TRUE(feet_of_tet_points(result.stack, result.tets, {}).empty());
}

TEST(CoreFeet, AFileHasThemBitForBit)
{
    openvdb::initialize();
    const ShellResult result = capsule_with_bones();
    ShellFile file;
    file.surface = result.level_set;
    file.depth = shell_depth_grid(result.tets, 0.1);
    file.stack = result.stack;
    file.tets = result.tets;
    file.core_feet = result.core_feet;
    file.parameters_json = "{}";
    file.report_json = report_json(result.report, false);
    const test::TemporaryFolder folder;
    write_shell_vdb(folder / "shell.vdb", file);
    const ShellFile again = read_shell_vdb(folder / "shell.vdb");
    ASSERT_EQ(again.core_feet.size(), file.core_feet.size());
    for (std::size_t v = 0; v < file.core_feet.size(); ++v) {
        EXPECT_EQ(again.core_feet[v].core, file.core_feet[v].core);
        EXPECT_EQ(again.core_feet[v].triangle, file.core_feet[v].triangle);
        EXPECT_EQ(again.core_feet[v].uvw, file.core_feet[v].uvw);
        EXPECT_EQ(again.core_feet[v].distance, file.core_feet[v].distance);
    }
    file.core_feet.clear();
    write_shell_vdb(folder / "without.vdb", file);
    EXPECT_TRUE(read_shell_vdb(folder / "without.vdb").core_feet.empty());
}

} // namespace
