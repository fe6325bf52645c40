// SPDX-License-Identifier: Apache-2.0
#include "vdb_shell/write/vdb_file.h"

#include "support/files.h"
#include "support/filled.h"
#include "support/verifications.h"
#include "vdb_shell/certify/stack_certificate.h"
#include "vdb_shell/certify/tet_signs.h"
#include "vdb_shell/core/error.h"
#include "vdb_shell/report/report.h"
#include "vdb_shell/shell/tessellate.h"
#include "vdb_shell/write/shell_points.h"
#include "vdb_shell/write/tet_file.h"
#include "write/hand_made.h"

#include <gtest/gtest.h>

// Shells with a filled core, to a .vdb and back, and as one list of tets.

namespace vdb_shell
{
namespace
{

using openvdb::Vec3s;
using test::same_bits;

ShellFile core_file_of(const ShellStack& stack)
{

    const ShellStack solid = test::hollow_ball();
    ShellFile file =
        test::hand_made_file({solid.layers[0], solid.splits[0], make_tets(solid)}, 0.1);
    file.stack = stack;
    file.tets = make_tets(stack);
    file.core = test::cone_core(stack, file.tets, Vec3s(0.01f, 0.02f, 0.03f));
    file.depth = shell_depth_grid(file.tets, file.surface->voxelSize()[0]);
    ShellReport report;
    report.signs = count_tet_signs(file.tets);
    report.shell_volume = tet_volume(file.tets);
    report.certificate = certify_stack(stack, PrismTest::twelve_tets);
    report.core_fill.emplace();
    report.core_fill->tets = file.core.tets.size();
    TetMesh alone = joined_tets(file.tets, file.core);
    alone.tets = file.core.tets;
    report.core_fill->volume = tet_volume(alone);
    file.report_json = report_json(report);

    return file;
}

/// With tets in the shell, and with none, so that all its vertices are points of the core.
std::vector<ShellStack> core_samples()
{
    ShellStack tapered = test::hollow_ball();
    tapered.tapered = true;
    return {test::hollow_ball(), tapered, test::empty_shell(test::icosphere(1, 1))};
}

TEST(CoreFile, ReadsBackBitForBit)
{
    const test::TemporaryFolder folder;
    for (const PointPlacement points : {PointPlacement::same_file, PointPlacement::beside})
        for (const ShellStack& stack : core_samples()) {
            const ShellFile written = core_file_of(stack);
            VdbWriteOptions options;
            options.points = points;
            write_shell_vdb(folder / "shell.vdb", written, options);
            const ShellFile read = read_shell_vdb(folder / "shell.vdb");
            EXPECT_TRUE(same_bits(read.core.points, written.core.points));
            EXPECT_TRUE(same_bits(read.core.source_vertex, written.core.source_vertex));
            EXPECT_TRUE(same_bits(read.core.tets, written.core.tets));
            EXPECT_TRUE(same_bits(read.tets.tets, written.tets.tets));
            EXPECT_EQ(read.stack.tapered, stack.tapered);
            const ShellInfo info = read_shell_info(folder / "shell.vdb");
            EXPECT_EQ(info.schema, kFilledSchema);
            EXPECT_EQ(info.core_tets, std::int64_t(written.core.tets.size()));
            EXPECT_EQ(info.grids.back(), "core_tets");
        }
}

/// Files without a core are what they were.
TEST(CoreFile, WithoutACoreNothingIsSaidOfIt)
{
    const test::TemporaryFolder folder;
    ShellFile file = core_file_of(test::hollow_ball());
    const std::string with = checksum_of(file.stack, file.tets, file.core);
    file.core = {};
    EXPECT_EQ(checksum_of(file.stack, file.tets, file.core), checksum_of(file.stack, file.tets));
    EXPECT_NE(checksum_of(file.stack, file.tets), with);
    write_shell_vdb(folder / "shell.vdb", file);
    EXPECT_EQ(read_shell_info(folder / "shell.vdb").schema, 1);
    EXPECT_TRUE(read_shell_vdb(folder / "shell.vdb").core.empty());
}

Verification entry_of_core(const ShellFile& file)
{
    return test::verification_of(file, "core fills the shell");
}

TEST(CoreFile, CheckProvesTheSolidAnew)
{
    for (const ShellStack& stack : core_samples()) {
        ShellFile file = core_file_of(stack);
        const Verification sound = entry_of_core(file);
        EXPECT_TRUE(sound.holds) << sound.detail;
        file.core.points.back() = Vec3s(0.9f, 0.9f, 0.9f);
        const Verification moved = entry_of_core(file);
        EXPECT_FALSE(moved.holds);
        EXPECT_NE(moved.detail.find("bad_tets"), std::string::npos) << moved.detail;
        // The report still tells of one.
        file.core = {};
        EXPECT_FALSE(entry_of_core(file).holds);
    }
}

TEST(CoreFile, RefusesWhatDoesNotFitTogether)
{
    const test::TemporaryFolder folder;
    const auto refused = [&](const ShellFile& file) {
        EXPECT_THROW(write_shell_vdb(folder / "shell.vdb", file), InvalidOption);
    };
    const ShellFile sound = core_file_of(test::hollow_ball());
    ShellFile file = sound;
    file.core.tets[3][1] = 100000;
    refused(file);
    file = sound;
    file.core.source_vertex.pop_back();
    refused(file);
    file = sound;
    file.core.points[0][0] = NAN;
    refused(file);
    file = sound;
    file.core.source_vertex[0] = 4000;
    refused(file);
}

TEST(CoreFile, TetFormatsTellTheCoreByMinusOne)
{
    const test::TemporaryFolder folder;
    const ShellFile file = core_file_of(test::hollow_ball());
    const TetMesh all = joined_tets(file.tets, file.core);
    write_tets(folder / "all.node", all);
    write_tets(folder / "all.mesh", all);
    write_tets(folder / "all.vtu", all);
    const std::string node = test::read_bytes(folder / "all.node");
    const std::string ele = test::read_bytes(folder / "all.ele");
    const std::string last = std::to_string(all.tets.size() - 1);
    EXPECT_EQ(node.substr(node.size() - 7), " -1 -1\n");
    EXPECT_NE(ele.find("\n" + last + " "), std::string::npos);
    EXPECT_EQ(ele.substr(ele.size() - 7), " -1 -1\n");
    const std::string mesh = test::read_bytes(folder / "all.mesh");
    EXPECT_NE(mesh.find(" 1\n"), std::string::npos);
    EXPECT_EQ(mesh.substr(mesh.size() - 7), " 2\nEnd\n");
    const std::string vtu = test::read_bytes(folder / "all.vtu");
    EXPECT_NE(vtu.find("type=\"Int32\" Name=\"layer\""), std::string::npos);
    EXPECT_EQ(vtu.find("type=\"UInt32\""), std::string::npos);
}

} // namespace
} // namespace vdb_shell
