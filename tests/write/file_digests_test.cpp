// SPDX-License-Identifier: Apache-2.0
#include "write/file_digests.h"

#include "io/vdb_seal.h"
#include "vdb_shell/core/error.h"
#include "vdb_shell/write/vdb_file.h"

#include "support/files.h"
#include "support/grids.h"
#include "support/shapes.h"
#include "write/hand_made.h"

#include <gtest/gtest.h>
#include <openvdb/io/File.h>
#include <openvdb/points/PointDataGrid.h>
#include <tbb/global_control.h>

#include <functional>

namespace vdb_shell
{
namespace
{

namespace fs = std::filesystem;
using openvdb::points::AttributeWriteHandle;
using openvdb::points::PointDataGrid;

/// A file written by this library, and then once more by OpenVDB.
class FileDigests : public testing::Test
{
protected:
    using Change = std::function<void(openvdb::GridPtrVec&, openvdb::MetaMap&)>;

    void write(const VdbWriteOptions& options = {}) const
    {
        const auto made = test::hand_made_shell(test::icosphere(1.0, 1), 0.6, {3});
        write_shell_vdb(path_, test::hand_made_file(made, 0.2), options);
    }

    void rewrite(const Change& change, std::uint32_t compression = openvdb::io::COMPRESS_ZIP) const
    {
        test::rewrite_vdb(path_, change, compression);
    }

    std::string complaint() const
    {
        return test::complaint_of([&] { read_shell_vdb(path_); });
    }

    template <typename Grid>
    static typename Grid::Ptr find(openvdb::GridPtrVec& grids, const char* name)
    {
        for (const openvdb::GridBase::Ptr& grid : grids)
            if (grid->getName() == name)
                return openvdb::gridPtrCast<Grid>(grid);
        return nullptr;
    }

    const test::TemporaryFolder folder_;
    const fs::path path_ = folder_ / "s.vdb";
};

TEST_F(FileDigests, HoldInWhatWasWritten)
{
    for (const bool half : {false, true})
        for (const auto points : {PointPlacement::same_file, PointPlacement::beside}) {
            write({points, half});
            const ShellFile file = read_shell_vdb(path_);
            // Five grids, their attributes, and the metadata of each file.
            EXPECT_GT(file.digests, 25u) << half;
        }
}

TEST_F(FileDigests, HoldInWhatAnotherProgramWroteOfIt)
{
    for (const bool half : {false, true})
        for (const std::uint32_t compression : {0u, 1u, 2u, 3u, 4u, 6u}) {
            write({PointPlacement::same_file, half});
            rewrite([](auto&, auto&) {}, compression);
            EXPECT_EQ(complaint(), "") << half << compression;
        }
}

TEST_F(FileDigests, NameTheVoxelGridThatChanged)
{
    for (const char* name : {"surface", "depth"}) {
        write();
        rewrite([&](auto& grids, auto&) {
            const auto grid = find<openvdb::FloatGrid>(grids, name);
            auto value = grid->beginValueOn();
            value.setValue(*value * 0.999f + 1e-4f);
        });
        EXPECT_NE(complaint().find(std::string("grid \"") + name + "\" is not what was written"),
                  std::string::npos)
            << complaint();
    }
}

TEST_F(FileDigests, NameTransformTopologyAndMetadata)
{
    const std::vector<std::function<void(openvdb::FloatGrid&)>> changes{
        [](auto& grid) { grid.setTransform(openvdb::math::Transform::createLinearTransform(0.1)); },
        [](auto& grid) { grid.beginValueOn().setValueOff(); },
        [](auto& grid) { grid.insertMeta("more", openvdb::StringMetadata("text")); },
        [](auto& grid) { grid.setGridClass(openvdb::GRID_UNKNOWN); },
        [](auto& grid) { grid.tree().root().setBackground(9.0f, false); }};
    for (const auto& change : changes) {
        write();
        rewrite([&](auto& grids, auto&) { change(*find<openvdb::FloatGrid>(grids, "depth")); });
        EXPECT_NE(complaint().find("grid \"depth\" is not what was written"), std::string::npos)
            << complaint();
    }
}

TEST_F(FileDigests, NameTheAttributeThatChanged)
{
    write();
    // No checksum covers the normals.
    rewrite([&](auto& grids, auto&) {
        auto& leaf = *find<PointDataGrid>(grids, "shell_points")->tree().beginLeaf();
        AttributeWriteHandle<openvdb::Vec3f> handle(leaf.attributeArray("N"));
        handle.set(0, openvdb::Vec3f(0.0f, 0.0f, 1.0f));
    });
    EXPECT_NE(complaint().find("attribute \"N\" of grid \"shell_points\""), std::string::npos)
        << complaint();
    write();
    rewrite([&](auto& grids, auto&) {
        test::drop_attribute(find<PointDataGrid>(grids, "shell_points")->tree(), "N");
    });
    EXPECT_NE(complaint().find("attribute \"N\" of grid \"shell_points\" is missing"),
              std::string::npos)
        << complaint();
}

TEST_F(FileDigests, NameChangedMetadata)
{
    write();
    rewrite([](auto&, auto& metadata) {
        metadata.insertMeta("vdb_shell_ripples", openvdb::Int32Metadata(7));
    });
    EXPECT_NE(complaint().find("its metadata is not what was written"), std::string::npos);
    write();
    rewrite([](auto&, auto& metadata) {
        metadata.insertMeta("comment", openvdb::StringMetadata("somebody else's"));
    });
    EXPECT_EQ(complaint(), "");
}

TEST_F(FileDigests, OldFilesHaveNone)
{
    write();
    rewrite([](auto&, auto& metadata) {
        metadata.removeMeta(kDigestsKey);
        metadata.removeMeta(kDigestCountKey);
    });
    EXPECT_EQ(complaint(), "");
    EXPECT_EQ(read_shell_vdb(path_).digests, 0u);
}

/// As when a bit in the name of the entry is flipped.
TEST_F(FileDigests, AreMissed)
{
    write();
    rewrite([](auto&, auto& metadata) { metadata.removeMeta(kDigestsKey); });
    EXPECT_NE(complaint().find("\"vdb_shell_digests\" is missing"), std::string::npos)
        << complaint();
}

TEST_F(FileDigests, AreTheSameForAnyNumberOfThreads)
{
    const auto grid = test::sphere_level_set(30.0f, 1.0f);
    const auto with = [&](std::size_t threads) {
        const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
        return digests_of(*grid).front().hex;
    };
    const std::string one = with(1);
    EXPECT_EQ(with(2), one);
    EXPECT_EQ(with(5), one);
}

} // namespace
} // namespace vdb_shell
