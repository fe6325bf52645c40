// SPDX-License-Identifier: Apache-2.0
#include "vdb_shell/io/volume_file.h"

#include "support/files.h"
#include "support/grids.h"
#include "vdb_shell/core/error.h"

#include <gtest/gtest.h>
#include <openvdb/io/File.h>

namespace vdb_shell::test
{
namespace
{

using openvdb::FloatGrid;
using openvdb::GridBase;

GridBase::Ptr float_grid(const std::string& name, float value)
{
    const FloatGrid::Ptr grid = FloatGrid::create();
    grid->setName(name);
    grid->tree().setValue({1, 2, 3}, value);
    return grid;
}

float value_in(const GridBase& grid)
{
    return dynamic_cast<const FloatGrid&>(grid).tree().getValue({1, 2, 3});
}

class VolumeFile : public ::testing::Test
{
protected:
    VolumeFile() { openvdb::initialize(); }

    /// By OpenVDB itself, which allows what write_volumes does not.
    void write(const openvdb::GridPtrVec& grids) const
    {
        openvdb::io::File file(path.string());
        file.write(grids);
        file.close();
    }
    std::string refusal(const std::vector<std::string>& names = {}) const
    {
        return complaint_of([&] { read_volumes(path, names); });
    }

    TemporaryFolder folder;
    const std::filesystem::path path = folder / "in.vdb";
};

TEST_F(VolumeFile, GridsComeInTheOrderOfTheirNamesOrOfThoseAskedFor)
{
    write({float_grid("z", 1), float_grid("a", 2), float_grid("m", 3)});
    const auto all = read_volumes(path);
    ASSERT_EQ(all.size(), 3u);
    EXPECT_EQ(value_in(*all[0]), 2);
    EXPECT_EQ(value_in(*all[1]), 3);
    EXPECT_EQ(value_in(*all[2]), 1);
    const auto two = read_volumes(path, {"z", "m"});
    ASSERT_EQ(two.size(), 2u);
    EXPECT_EQ(value_in(*two[0]), 1);
    EXPECT_EQ(value_in(*two[1]), 3);
}

TEST_F(VolumeFile, OtherTypesAreLeftOutUnlessAskedFor)
{
    write({float_grid("a", 1), empty_grid("mask", "hidden")});
    const auto all = read_volumes(path);
    ASSERT_EQ(all.size(), 1u);
    EXPECT_EQ(all[0]->getName(), "a");
    EXPECT_NE(refusal({"hidden"}).find("\"hidden\" is no volume"), std::string::npos);
    EXPECT_NE(refusal({"b"}).find("has no grid \"b\"; it has \"a\" (float"), std::string::npos);
    write({empty_grid("mask", "hidden")});
    EXPECT_NE(refusal().find("has no volume"), std::string::npos);
}

TEST_F(VolumeFile, ANameOfSeveralGridsIsRefusedAndOthersAreRead)
{
    write({float_grid("a", 1), float_grid("d", 2), float_grid("d", 3)});
    ::testing::internal::CaptureStderr();
    EXPECT_NE(refusal().find("two grids of the name \"d\""), std::string::npos) << refusal();
    EXPECT_NE(refusal({"d"}).find("two grids of the name \"d\""), std::string::npos);
    ASSERT_EQ(read_volumes(path, {"a"}).size(), 1u);
    // OpenVDB would warn, and take the first.
    EXPECT_EQ(::testing::internal::GetCapturedStderr(), "");
}

TEST_F(VolumeFile, WritesWhatItReadsWithTheSameBytes)
{
    write({float_grid("a", 1), float_grid("b", 2)});
    const auto grids = read_volumes(path);
    const auto first = folder / "first.vdb", second = folder / "second.vdb";
    write_volumes(first, grids);
    write_volumes(second, read_volumes(first));
    EXPECT_EQ(read_bytes(first), read_bytes(second));
    EXPECT_EQ(value_in(*read_volumes(second, {"b"})[0]), 2);
    EXPECT_THROW(write_volumes(second, {float_grid("a", 1), float_grid("a", 2)}), InvalidOption);
    EXPECT_EQ(read_bytes(first), read_bytes(second));
}

} // namespace
} // namespace vdb_shell::test
