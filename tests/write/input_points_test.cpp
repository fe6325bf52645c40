// SPDX-License-Identifier: Apache-2.0
#include "vdb_shell/write/input_points.h"

#include "support/files.h"
#include "support/shapes.h"
#include "vdb_shell/core/error.h"
#include "vdb_shell/pipeline.h"
#include "vdb_shell/write/tet_file.h"
#include "vdb_shell/write/vdb_file.h"
#include "write/hand_made.h"

#include <gtest/gtest.h>

// The surface before remeshing, bound to the shell that was made after it.

namespace vdb_shell
{
namespace
{

using openvdb::Vec3d;
using openvdb::Vec3s;
using test::same_bits;

ShellResult remeshed_ball(double edge_length)
{
    ShellOptions options;
    options.level_set.resolution = 24;
    options.coverage.samples = 0;
    options.remesh.edge_length = edge_length;
    return build_shell(test::icosphere(1, 2), options);
}

ShellFile file_of(ShellResult& result)
{
    ShellFile file;
    file.surface = result.level_set;
    file.depth = shell_depth_grid(result.tets, result.report.field.voxel_size);
    file.input = input_points_of(*result.remesh_map);
    file.stack = std::move(result.stack);
    file.tets = std::move(result.tets);
    return file;
}

TEST(InputPoints, LieOnTheShellsSurfaceByTheirWeights)
{
    ShellResult result = remeshed_ball(0.4);
    const double tolerance = result.report.remesh->tolerance;
    const ShellFile file = file_of(result);
    const InputPoints& input = file.input;
    ASSERT_TRUE(same_bits(input.points, test::icosphere(1, 2).points));
    require_consistent(input, file.stack.surface(0).size());
    for (std::size_t i = 0; i < input.points.size(); ++i) {
        Vec3d sum(0.0);
        double weights = 0;
        for (int k = 0; k < 3; ++k) {
            EXPECT_GE(input.weights[i][k], 0.0f);
            sum += double(input.weights[i][k]) * Vec3d(file.stack.surface(0)[input.corners[i][k]]);
            weights += double(input.weights[i][k]);
        }
        EXPECT_NEAR(weights, 1, 1e-6);
        EXPECT_LE((sum - Vec3d(input.points[i])).length(), 1.001 * tolerance) << i;
    }
}

TEST(InputPoints, AVdbGivesThemBackBitForBit)
{
    const test::TemporaryFolder folder;
    ShellResult result = remeshed_ball(0.4);
    ShellFile file = file_of(result);
    for (const PointPlacement points : {PointPlacement::same_file, PointPlacement::beside}) {
        VdbWriteOptions options;
        options.points = points;
        write_shell_vdb(folder / "shell.vdb", file, options);
        const InputPoints found = read_shell_vdb(folder / "shell.vdb").input;
        EXPECT_TRUE(same_bits(found.points, file.input.points));
        EXPECT_TRUE(same_bits(found.corners, file.input.corners));
        EXPECT_TRUE(same_bits(found.weights, file.input.weights));
        const ShellInfo info = read_shell_info(folder / "shell.vdb");
        EXPECT_EQ(info.input_points, std::int64_t(file.input.points.size()));
    }
    file.input = {};
    write_shell_vdb(folder / "shell.vdb", file);
    EXPECT_TRUE(read_shell_vdb(folder / "shell.vdb").input.empty());
}

TEST(InputPoints, WhatDoesNotFitTheShellIsNotWritten)
{
    const test::TemporaryFolder folder;
    ShellResult result = remeshed_ball(0.4);
    ShellFile file = file_of(result);
    const InputPoints good = file.input;
    file.input.corners[3][1] = std::uint32_t(file.stack.surface(0).size());
    EXPECT_THROW(write_shell_vdb(folder / "shell.vdb", file), InvalidOption);
    file.input = good;
    file.input.weights.pop_back();
    EXPECT_THROW(write_shell_vdb(folder / "shell.vdb", file), InvalidOption);
    EXPECT_FALSE(std::filesystem::exists(folder / "shell.vdb"));
}

TEST(InputPoints, StandInAVtuAsArraysOfTheWholeFile)
{
    const test::TemporaryFolder folder;
    ShellResult result = remeshed_ball(0.4);
    const ShellFile file = file_of(result);
    PointExtras extras;
    extras.input = file.input;
    write_tets(folder / "shell.vtu", file.tets, {}, {}, extras);
    const std::string text = test::read_bytes(folder / "shell.vtu");
    const std::string field =
        text.substr(text.find("<FieldData>"), text.find("</FieldData>") - text.find("<FieldData>"));
    const std::string tuples =
        "NumberOfTuples=\"" + std::to_string(file.input.points.size()) + "\"";
    for (const char* name : {"input_points", "input_corners", "input_weights"}) {
        const std::size_t at = field.find("Name=\"" + std::string(name) + "\"");
        ASSERT_NE(at, std::string::npos) << name;
        EXPECT_NE(field.substr(at, field.find('>', at) - at).find(tuples), std::string::npos);
    }
    write_tets(folder / "shell.vtu", file.tets);
    EXPECT_EQ(test::read_bytes(folder / "shell.vtu").find("FieldData"), std::string::npos);
}

} // namespace
} // namespace vdb_shell
