// SPDX-License-Identifier: Apache-2.0
#include "vdb_shell/write/vdb_file.h"

#include "support/broken_shells.h"
#include "support/files.h"
#include "support/verifications.h"
#include "vdb_shell/certify/stack_certificate.h"
#include "vdb_shell/layers/cut_layers.h"
#include "vdb_shell/report/report.h"
#include "write/hand_made.h"

#include <gtest/gtest.h>

// Stacks of several layers to a .vdb and back.

namespace vdb_shell
{
namespace
{

using openvdb::Vec3d;
using test::same_bits;
using test::verification_of;

/// Three layers of a ball; vertex 0 is pinned in the first layer, vertex 5 in the second, vertex 9
/// in all.
ShellStack pinned_layers()
{
    test::SplitShell ball = test::scaled_shell(test::icosphere(1, 2), 0.25f);
    ball.shell.inner[9] = ball.shell.outer[9];
    LayerOptions options;
    options.layers = 3;
    ShellStack stack =
        cut_layers(one_layer(ball.shell, ball.split), options, PrismTest::twelve_tets).stack;
    auto& layers = stack.layers;
    layers[0].inner[0] = layers[1].outer[0] = layers[0].outer[0];
    layers[1].inner[5] = layers[2].outer[5] = layers[1].outer[5];
    return stack;
}

ShellFile layered_file_of(const ShellStack& stack)
{
    const PrismShell& first = stack.layers[0];
    ShellFile file =
        test::hand_made_file({first, stack.splits[0], make_tets(first, stack.splits[0])}, 0.1);
    file.stack = stack;
    file.tets = make_tets(stack);
    file.depth = shell_depth_grid(file.tets, 0.1);
    ShellReport report;
    report.certificate = certify_stack(stack, PrismTest::twelve_tets);
    file.report_json = report_json(report);
    return file;
}

TEST(LayeredFile, ReadsBackBitForBit)
{
    const test::TemporaryFolder folder;
    ShellStack stack = pinned_layers();
    stack.splits[1].ripples = 2;
    stack.layers[2].stop.assign(stack.surface(0).size(), StopReason::prism);
    stack.layers[0].stop = stack.layers[1].stop = stack.layers[2].stop;
    for (const std::size_t skin : {0U, 1U, 3U}) {
        stack.skin = skin;
        const ShellFile written = layered_file_of(stack);
        write_shell_vdb(folder / "shell.vdb", written);
        const ShellFile read = read_shell_vdb(folder / "shell.vdb");
        EXPECT_EQ(read.stack.skin, skin);
        ASSERT_EQ(read.stack.layers.size(), 3U);
        for (std::size_t k = 0; k < 3; ++k) {
            EXPECT_TRUE(same_bits(read.stack.layers[k].outer, stack.layers[k].outer));
            EXPECT_TRUE(same_bits(read.stack.layers[k].inner, stack.layers[k].inner));
            EXPECT_TRUE(same_bits(read.stack.layers[k].triangles, stack.triangles()));
            EXPECT_TRUE(same_bits(read.stack.layers[k].stop, stack.layers[k].stop));
            EXPECT_TRUE(same_bits(read.stack.splits[k].order, stack.splits[k].order));
        }
        EXPECT_TRUE(same_bits(read.tets.points, written.tets.points));
        EXPECT_TRUE(same_bits(read.tets.tets, written.tets.tets));
        EXPECT_TRUE(same_bits(read.tets.layer, written.tets.layer));
        EXPECT_TRUE(same_bits(read.tets.prism_layer, written.tets.prism_layer));
        EXPECT_TRUE(test::same_grid(*read.depth, *written.depth));
        const ShellInfo info = read_shell_info(folder / "shell.vdb");
        EXPECT_EQ(info.schema, kLayeredSchema);
        EXPECT_EQ(info.layers, 3);
        EXPECT_EQ(info.skin, std::int64_t(skin));
    }
}

TEST(LayeredFile, OneLayerBelowTheSurfaceIsSchemaOne)
{
    const test::TemporaryFolder folder;
    const test::SplitShell ball = test::scaled_shell(test::icosphere(1, 1), 0.5f);
    ShellStack stack = one_layer(ball.shell, ball.split);
    write_shell_vdb(folder / "inward.vdb", layered_file_of(stack));
    EXPECT_EQ(read_shell_info(folder / "inward.vdb").schema, 1);
    stack.skin = 1;
    write_shell_vdb(folder / "outward.vdb", layered_file_of(stack));
    EXPECT_EQ(read_shell_info(folder / "outward.vdb").schema, kLayeredSchema);
}

TEST(LayeredFile, CheckNamesTheLayerThatFails)
{
    ShellStack stack = pinned_layers();
    EXPECT_TRUE(verification_of(layered_file_of(stack)).holds);
    std::swap(stack.splits[1].order[40][0], stack.splits[1].order[40][1]);
    ShellFile file = layered_file_of(pinned_layers()); // claims to be certified
    file.stack = stack;
    file.tets = make_tets(stack);
    const Verification entry = verification_of(file);
    EXPECT_FALSE(entry.holds);
    EXPECT_NE(entry.detail.find("layer 1: non_conforming_edges"), std::string::npos)
        << entry.detail;
}

// Radii 1, 0.75, 0.5 and 0.25, layers equally thick: depth is the share of the way. The flat
// triangles of the ball lie less than 0.005 below it.
TEST(LayeredFile, DepthGoesEvenlyThroughTheLayers)
{
    const test::SplitShell ball = test::scaled_shell(test::icosphere(1, 3), 0.25f);
    LayerOptions options;
    options.layers = 3;
    const TetMesh tets = make_tets(
        cut_layers(one_layer(ball.shell, ball.split), options, PrismTest::twelve_tets).stack);
    const auto depth = shell_depth_grid(tets, 0.05);
    std::size_t voxels = 0;
    for (auto value = depth->cbeginValueOn(); value; ++value, ++voxels) {
        const double radius = depth->indexToWorld(value.getCoord()).length();
        EXPECT_NEAR(*value, (1 - radius) / 0.75, 0.01);
    }
    EXPECT_GT(voxels, 10000U);
}

} // namespace
} // namespace vdb_shell
