// SPDX-License-Identifier: Apache-2.0
#include "vdb_shell/core/error.h"
#include "vdb_shell/write/vdb_file.h"

#include "support/files.h"
#include "support/grids.h"
#include "support/shapes.h"
#include "write/hand_made.h"

#include <gtest/gtest.h>
#include <openvdb/io/File.h>
#include <openvdb/points/AttributeArray.h>
#include <openvdb/points/PointDataGrid.h>

#include <cmath>
#include <cstring>
#include <functional>

namespace vdb_shell
{
namespace
{

namespace fs = std::filesystem;
using openvdb::points::AttributeWriteHandle;
using openvdb::points::PointDataGrid;

class VdbDamage : public testing::Test
{
protected:
    VdbDamage()
    {
        write_shell_vdb(path_, test::hand_made_file(
                                   test::hand_made_shell(test::icosphere(1.0, 1), 0.6, {3}), 0.2));
    }

    /// What reading says; empty when it succeeds.
    std::string complaint() const
    {
        return test::complaint_of([&] { read_shell_vdb(path_); });
    }

    /// Expects a complaint with the file's name and all of `parts`.
    void expect_complaint(const std::vector<std::string>& parts) const
    {
        const std::string text = complaint();
        EXPECT_NE(text.find("shell.vdb"), std::string::npos) << text;
        for (const std::string& part : parts)
            EXPECT_NE(text.find(part), std::string::npos) << part << " in: " << text;
    }

    /// Writes the file anew with something changed, through OpenVDB, and without the digests, which
    /// would tell of the change before anybody looks at it.
    void rewrite(const std::function<void(openvdb::GridPtrVec&, openvdb::MetaMap&)>& change) const
    {
        test::rewrite_vdb(path_, [&](openvdb::GridPtrVec& grids, openvdb::MetaMap& metadata) {
            for (const char* key : {"vdb_shell_digests", "vdb_shell_digest_count"})
                metadata.removeMeta(key);
            change(grids, metadata);
        });
    }

    /// Sets the first row of an attribute of one grid.
    template <typename T>
    void spoil(const char* grid, const char* attribute, openvdb::Index element, T value) const
    {
        rewrite([&](openvdb::GridPtrVec& grids, openvdb::MetaMap&) {
            for (const openvdb::GridBase::Ptr& one : grids)
                if (one->getName() == grid) {
                    auto& leaf = *openvdb::gridPtrCast<PointDataGrid>(one)->tree().beginLeaf();
                    AttributeWriteHandle<T> handle(leaf.attributeArray(attribute));
                    handle.set(0, element, value);
                }
        });
    }

    const test::TemporaryFolder folder_;
    const fs::path path_ = folder_ / "shell.vdb";
};

TEST_F(VdbDamage, UndamagedFileReads)
{
    EXPECT_EQ(complaint(), "");
    rewrite([](openvdb::GridPtrVec&, openvdb::MetaMap&) {});
    EXPECT_EQ(complaint(), "");
}

TEST_F(VdbDamage, NoSuchFileEmptyFileFolderOtherFile)
{
    fs::remove(path_);
    expect_complaint({"no such file"});
    fs::create_directory(path_);
    expect_complaint({"a folder, not a file"});
    fs::remove(path_);
    test::write_bytes(path_, "");
    expect_complaint({"empty"});
    test::write_bytes(path_, "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    expect_complaint({"not a .vdb"});
    test::write_bytes(path_, "v");
    expect_complaint({"not a .vdb"});
}

TEST_F(VdbDamage, TruncatedAnywhere)
{
    const std::string whole = test::read_bytes(path_);
    for (std::size_t length = 1; length < whole.size(); length += length < 3000 ? 37 : 4999) {
        test::write_bytes(path_, whole.substr(0, length));
        EXPECT_NE(complaint(), "") << "cut to " << length << " of " << whole.size() << " bytes";
    }
    test::write_bytes(path_, whole.substr(0, whole.size() - 1));
    expect_complaint({"truncated", "shell_tets"});
}

TEST_F(VdbDamage, LengthsBeyondTheFile)
{
    std::string bytes = test::read_bytes(path_);
    const std::size_t metadata = 57, name = metadata + 4;
    const std::uint32_t huge = 0xfffffff0u;
    std::memcpy(&bytes[name], &huge, sizeof huge);
    test::write_bytes(path_, bytes);
    expect_complaint({"a metadata name", "4294967280"});
}

TEST_F(VdbDamage, OtherFormatVersion)
{
    std::string bytes = test::read_bytes(path_);
    bytes[8] = 99;
    test::write_bytes(path_, bytes);
    expect_complaint({"version is 99"});
}

TEST_F(VdbDamage, MetadataMissingWrongOrTooNew)
{
    const auto with = [&](const char* key, const openvdb::Metadata& value) {
        rewrite([&](openvdb::GridPtrVec&, openvdb::MetaMap& map) {
            map.removeMeta(key);
            map.insertMeta(key, value);
        });
    };
    with("vdb_shell_tets", openvdb::Int32Metadata(-4));
    expect_complaint({"vdb_shell_tets", "-4"});
    with("vdb_shell_tets", openvdb::StringMetadata("many"));
    expect_complaint({"vdb_shell_tets", "string", "int32"});
    with("vdb_shell_tets", openvdb::Int32Metadata(2000000000));
    expect_complaint({"shell_tets", "2000000000"});
    with("vdb_shell_points_file", openvdb::StringMetadata("../elsewhere.vdb"));
    expect_complaint({"../elsewhere.vdb"});
    with("vdb_shell_schema", openvdb::Int32Metadata(kShellSchema + 1));
    expect_complaint({"schema is " + std::to_string(kShellSchema + 1)});
    rewrite(
        [](openvdb::GridPtrVec&, openvdb::MetaMap& map) { map.removeMeta("vdb_shell_schema"); });
    expect_complaint({"holds no shell"});
}

TEST_F(VdbDamage, GridMissingOrOfAnotherType)
{
    rewrite([](openvdb::GridPtrVec& grids, openvdb::MetaMap&) {
        for (openvdb::GridBase::Ptr& grid : grids)
            if (grid->getName() == "depth") {
                grid = openvdb::DoubleGrid::create(0.0);
                grid->setName("depth");
            }
    });
    expect_complaint({"\"depth\"", "Tree_double"});
    for (const char* name : {"shell_tets", "surface"}) {
        rewrite([&](openvdb::GridPtrVec& grids, openvdb::MetaMap&) {
            for (std::size_t i = 0; i < grids.size(); ++i)
                if (grids[i]->getName() == name)
                    grids.erase(grids.begin() + std::ptrdiff_t(i));
            for (const openvdb::GridBase::Ptr& grid : grids)
                if (grid->getName() == "depth")
                    grid->setName("other");
        });
        EXPECT_NE(complaint(), "") << name;
    }
}

TEST_F(VdbDamage, IdsOutOfRangeOrTwice)
{
    const std::string whole = test::read_bytes(path_);
    const auto restore = [&] { test::write_bytes(path_, whole); };
    spoil<std::int32_t>("shell_tets", "tet", 2, 123456);
    expect_complaint({"shell_tets", "\"tet\"", "123456"});
    restore();
    spoil<std::int32_t>("shell_tets", "id", 0, -1);
    expect_complaint({"shell_tets", "\"id\"", "-1"});
    restore();
    spoil<std::int32_t>("shell_prisms", "prism_pts", 5, 83 * 2);
    expect_complaint({"shell_prisms", "\"prism_pts\"", "166"});
    restore();
    spoil<std::int32_t>("shell_points", "stop_reason", 0, kStopReasonCount);
    expect_complaint({"shell_points", "\"stop_reason\"", std::to_string(kStopReasonCount)});
    restore();
    rewrite([](openvdb::GridPtrVec& grids, openvdb::MetaMap&) {
        for (const openvdb::GridBase::Ptr& one : grids)
            if (one->getName() == "shell_points")
                for (auto leaf = openvdb::gridPtrCast<PointDataGrid>(one)->tree().beginLeaf(); leaf;
                     ++leaf) {
                    AttributeWriteHandle<std::int32_t> handle(leaf->attributeArray("id"));
                    handle.set(0, 5);
                }
    });
    expect_complaint({"shell_points", "5 appears twice"});
}

TEST_F(VdbDamage, CoordinateNotFinite)
{
    spoil<openvdb::Vec3f>("shell_points", "rest", 0, openvdb::Vec3f(0.0f, std::nanf(""), 0.0f));
    expect_complaint({"\"rest\"", "not finite"});
}

TEST_F(VdbDamage, CoordinateMoved)
{
    spoil<openvdb::Vec3f>("shell_points", "rest", 0, openvdb::Vec3f(0.5f));
    EXPECT_NE(complaint(), "");
}

TEST_F(VdbDamage, AttributeMissingOrOfAnotherTypeOrStride)
{
    const auto replaced = [&](const std::function<void(openvdb::points::PointDataTree&)>& append) {
        rewrite([&](openvdb::GridPtrVec& grids, openvdb::MetaMap&) {
            for (const openvdb::GridBase::Ptr& one : grids)
                if (one->getName() == "shell_tets") {
                    auto& tree = openvdb::gridPtrCast<PointDataGrid>(one)->tree();
                    test::drop_attribute(tree, "tet");
                    append(tree);
                }
        });
    };
    const std::string whole = test::read_bytes(path_);
    replaced([](auto&) {});
    expect_complaint({"shell_tets", "\"tet\"", "missing"});
    test::write_bytes(path_, whole);
    replaced([](auto& tree) { test::append_attribute<std::int64_t>(tree, "tet", 0, 4); });
    expect_complaint({"shell_tets", "\"tet\"", "int64", "int32"});
    test::write_bytes(path_, whole);
    replaced([](auto& tree) { test::append_attribute<std::int32_t>(tree, "tet", 0, 3); });
    expect_complaint({"shell_tets", "\"tet\"", "stride 3"});
}

} // namespace
} // namespace vdb_shell
