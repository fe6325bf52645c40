// SPDX-License-Identifier: Apache-2.0
#include "vdb_shell/write/vdb_file.h"

#include "support/files.h"
#include "support/tapered.h"
#include "support/verifications.h"
#include "vdb_shell/certify/conformity.h"
#include "vdb_shell/certify/overlaps.h"
#include "vdb_shell/certify/stack_certificate.h"
#include "vdb_shell/certify/tet_signs.h"
#include "vdb_shell/core/error.h"
#include "vdb_shell/report/report.h"
#include "vdb_shell/shell/tessellate.h"
#include "vdb_shell/write/shell_points.h"
#include "vdb_shell/write/verify_file.h"
#include "write/hand_made.h"

#include <gtest/gtest.h>

// Stacks whose vertices share inner points, to a .vdb and back.

namespace vdb_shell
{
namespace
{

using openvdb::Vec3s;
using test::same_bits;

ShellFile tapered_file_of(const ShellStack& stack)
{
    const PrismShell& first = stack.layers[0];
    ShellFile file = test::hand_made_file({first, stack.splits[0], make_tets(stack)}, 0.1);
    file.stack = stack;
    file.tets = make_tets(stack);
    file.depth = shell_depth_grid(file.tets, file.surface->voxelSize()[0]);
    ShellReport report;
    report.signs = count_tet_signs(file.tets);
    report.shell_volume = tet_volume(file.tets);
    report.certificate = certify_stack(stack, PrismTest::twelve_tets);
    file.report_json = report_json(report);
    return file;
}

std::vector<ShellStack> samples()
{
    // One ends in an outer point of another vertex, one in its own.
    ShellStack sideways = test::coned(test::octahedron(), Vec3s(1, 0, 0));
    sideways.layers[0].inner[3] = sideways.layers[0].outer[3];
    return {test::two_sheets(), test::pinched_rod(), test::layers_to_a_point(), sideways,
            test::coned(test::icosphere(1, 1), Vec3s(0))};
}

TEST(TaperedFile, ReadsBackBitForBit)
{
    const test::TemporaryFolder folder;
    for (const ShellStack& stack : samples()) {
        const ShellFile written = tapered_file_of(stack);
        write_shell_vdb(folder / "shell.vdb", written);
        const ShellFile read = read_shell_vdb(folder / "shell.vdb");
        EXPECT_TRUE(read.stack.tapered);
        ASSERT_EQ(read.stack.layers.size(), stack.layers.size());
        for (std::size_t k = 0; k < stack.layers.size(); ++k) {
            EXPECT_TRUE(same_bits(read.stack.layers[k].outer, stack.layers[k].outer));
            EXPECT_TRUE(same_bits(read.stack.layers[k].inner, stack.layers[k].inner));
            EXPECT_TRUE(same_bits(read.stack.layers[k].triangles, stack.triangles()));
            EXPECT_TRUE(same_bits(read.stack.splits[k].order, stack.splits[k].order));
        }
        EXPECT_TRUE(same_bits(read.tets.points, written.tets.points));
        EXPECT_TRUE(same_bits(read.tets.tets, written.tets.tets));
        EXPECT_TRUE(same_bits(read.tets.source_vertex, written.tets.source_vertex));
        EXPECT_TRUE(same_bits(read.tets.layer, written.tets.layer));
        EXPECT_TRUE(same_bits(read.tets.prism, written.tets.prism));
        EXPECT_TRUE(same_bits(read.tets.prism_layer, written.tets.prism_layer));
        const ShellInfo info = read_shell_info(folder / "shell.vdb");
        EXPECT_EQ(info.schema, kTaperedSchema);
        EXPECT_TRUE(info.tapered);
    }
}

TEST(TaperedFile, CheckProvesItAnew)
{
    const test::TemporaryFolder folder;
    for (const ShellStack& stack : samples()) {
        write_shell_vdb(folder / "shell.vdb", tapered_file_of(stack));
        std::size_t looked_at = 0;
        for (const Verification& entry : verify_shell(read_shell_vdb(folder / "shell.vdb")))
            // The level set is that of another solid.
            if (entry.what.find("level set") == std::string::npos &&
                entry.what.find("surface") == std::string::npos) {
                EXPECT_TRUE(entry.holds) << entry.what << ": " << entry.detail;
                ++looked_at;
            }
        EXPECT_GE(looked_at, 5U);
    }
    ShellFile false_claim = tapered_file_of(test::two_sheets());
    false_claim.stack = test::tapered(test::plate_shell(0.7f, 0.65f));
    false_claim.tets = make_tets(false_claim.stack);
    const Verification claim = test::verification_of(false_claim);
    EXPECT_FALSE(claim.holds);
    EXPECT_NE(claim.detail.find("inner_contacts"), std::string::npos) << claim.detail;
}

TEST(TaperedFile, PillarsKeepTheirPointsAndNameThatOfTheTets)
{
    const ShellStack stack = test::coned(test::octahedron(), Vec3s(0));
    const TetMesh tets = make_tets(stack);
    const ShellPoints points = number_points(stack, tets);
    ASSERT_EQ(points.position.size(), 12U);
    for (std::size_t i = 6; i < 12; ++i) {
        EXPECT_EQ(points.vertex[i], i - 6);
        EXPECT_EQ(points.tet_point[i], 6);
    }
    EXPECT_EQ(points.id_of_tet_point.back(), 6U);
}

TEST(TaperedFile, TheChecksumTellsWhetherPointsAreShared)
{
    ShellStack stack = test::tapered(test::scaled_shell(test::icosphere(1, 1), 0.5f));
    const std::string tapered = checksum_of(stack, make_tets(stack));
    stack.tapered = false;
    EXPECT_NE(checksum_of(stack, make_tets(stack)), tapered);
}

TEST(TaperedFile, RefusesPointsThatDifferInTheSignOfAZero)
{
    ShellStack stack = test::coned(test::octahedron(), Vec3s(0));
    stack.layers[0].inner[4][1] = -0.0f;
    const TetMesh tets = make_tets(stack);
    EXPECT_EQ(tets.tets.size(), 8U);
    EXPECT_THROW(require_consistent(stack, tets), InvalidOption);
}

// The point in the middle has depth 1, so depth falls evenly along each ray.
TEST(TaperedFile, DepthGoesEvenlyToASharedPoint)
{
    const TetMesh tets = make_tets(test::coned(test::icosphere(1, 3), Vec3s(0)));
    const auto depth = shell_depth_grid(tets, 0.05);
    std::size_t voxels = 0;
    for (auto value = depth->cbeginValueOn(); value; ++value, ++voxels)
        EXPECT_NEAR(*value, 1 - depth->indexToWorld(value.getCoord()).length(), 0.01);
    EXPECT_NEAR(double(voxels) * 0.05 * 0.05 * 0.05, tet_volume(tets), 0.05);
}

} // namespace
} // namespace vdb_shell
