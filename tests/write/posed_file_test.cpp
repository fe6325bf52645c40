// SPDX-License-Identifier: Apache-2.0
#include "vdb_shell/write/vdb_file.h"

#include "vdb_shell/core/error.h"
#include "vdb_shell/write/tet_file.h"

#include "support/files.h"
#include "support/grids.h"
#include "support/shapes.h"
#include "write/hand_made.h"

#include <gtest/gtest.h>

// Shells that know where their points were at rest, to a .vdb and back.

namespace vdb_shell
{
namespace
{

using openvdb::Vec3s;

ShellFile posed_sample()
{
    const auto made = test::hand_made_shell(test::icosphere(1.0, 1), 0.6, {3});
    ShellFile file = test::hand_made_file(made, 0.2);
    for (std::size_t k = 0; k < file.stack.surfaces(); ++k) {
        file.rest.surface.push_back(file.stack.surface(k));
        for (Vec3s& p : file.rest.surface.back())
            p = Vec3s(p[2] + 7.0f, p[0] / 3.0f, -p[1]);
    }
    return file;
}

TEST(PosedFile, ReadsBackBitForBit)
{
    const test::TemporaryFolder folder;
    const ShellFile written = posed_sample();
    for (const auto points : {PointPlacement::same_file, PointPlacement::beside}) {
        write_shell_vdb(folder / "p.vdb", written, {points, false});
        EXPECT_EQ(read_shell_info(folder / "p.vdb").schema, kPosedSchema);
        EXPECT_TRUE(read_shell_info(folder / "p.vdb").posed);
        const ShellFile read = read_shell_vdb(folder / "p.vdb");
        ASSERT_TRUE(read.rest.posed());
        ASSERT_EQ(read.rest.surface.size(), 2U);
        for (std::size_t k = 0; k < 2; ++k) {
            EXPECT_TRUE(test::same_bits(read.rest.surface[k], written.rest.surface[k])) << k;
            EXPECT_TRUE(test::same_bits(read.stack.surface(k), written.stack.surface(k))) << k;
            EXPECT_EQ(rest_stack(read).surface(k), written.rest.surface[k]);
        }
    }
}

TEST(PosedFile, AShellAtRestIsItsOwnRest)
{
    ShellFile file = posed_sample();
    file.rest = {};
    EXPECT_EQ(rest_stack(file).surface(1), file.stack.surface(1));
    const test::TemporaryFolder folder;
    write_shell_vdb(folder / "r.vdb", file);
    EXPECT_EQ(read_shell_info(folder / "r.vdb").schema, 1);
    EXPECT_FALSE(read_shell_vdb(folder / "r.vdb").rest.posed());
}

TEST(PosedFile, RestOfOtherSizeIsNotWritten)
{
    const test::TemporaryFolder folder;
    ShellFile file = posed_sample();
    file.rest.surface[1].pop_back();
    EXPECT_THROW(write_shell_vdb(folder / "p.vdb", file), InvalidOption);
    file.rest.surface.pop_back();
    EXPECT_THROW(write_shell_vdb(folder / "p.vdb", file), InvalidOption);
    EXPECT_FALSE(std::filesystem::exists(folder / "p.vdb"));
}

TEST(PosedFile, VelocitiesReadBackBitForBit)
{
    const test::TemporaryFolder folder;
    ShellFile written = posed_sample();
    EXPECT_TRUE(written.rest.velocity.empty());
    write_shell_vdb(folder / "still.vdb", written);
    EXPECT_TRUE(read_shell_vdb(folder / "still.vdb").rest.velocity.empty());
    written.rest.velocity.surface = written.rest.surface;
    for (std::vector<Vec3s>& surface : written.rest.velocity.surface)
        for (Vec3s& v : surface)
            v = Vec3s(v[1] / 7.0f, -v[0], 1e-30f);
    write_shell_vdb(folder / "v.vdb", written);
    const ShellFile read = read_shell_vdb(folder / "v.vdb");
    ASSERT_EQ(read.rest.velocity.surface.size(), 2U);
    for (std::size_t k = 0; k < 2; ++k)
        EXPECT_TRUE(
            test::same_bits(read.rest.velocity.surface[k], written.rest.velocity.surface[k]));
    written.rest.velocity.surface[0].pop_back();
    EXPECT_THROW(write_shell_vdb(folder / "w.vdb", written), InvalidOption);
}

TEST(PosedFile, AMissingRestIsRefused)
{
    const test::TemporaryFolder folder;
    write_shell_vdb(folder / "p.vdb", posed_sample());
    test::rewrite_vdb(folder / "p.vdb", [](openvdb::GridPtrVec& grids, openvdb::MetaMap& metadata) {
        for (const char* key : {"vdb_shell_digests", "vdb_shell_digest_count"})
            metadata.removeMeta(key);
        for (const openvdb::GridBase::Ptr& grid : grids)
            if (grid->getName() == "shell_points")
                test::drop_attribute(
                    openvdb::gridPtrCast<openvdb::points::PointDataGrid>(grid)->tree(), "rest");
    });
    EXPECT_NE(test::complaint_of([&] { read_shell_vdb(folder / "p.vdb"); }).find("\"rest\""),
              std::string::npos);
}

TEST(PosedFile, TetsOfVtuHaveTheirRest)
{
    const test::TemporaryFolder folder;
    const ShellFile file = posed_sample();
    write_tets(folder / "p.vtu", file.tets, {}, {},
               {{}, {}, vectors_of_tet_points(file.tets, file.rest), {}});
    EXPECT_NE(test::read_bytes(folder / "p.vtu").find("Name=\"rest\""), std::string::npos);
    EXPECT_THROW(write_tets(folder / "q.vtu", file.tets, {}, {}, {{}, {}, {}, {Vec3s(0)}}),
                 InvalidOption);
    EXPECT_THROW(write_tets(folder / "q.vtu", file.tets, {}, {}, {{}, {}, {Vec3s(0)}, {}}),
                 InvalidOption);
}

} // namespace
} // namespace vdb_shell
