// SPDX-License-Identifier: Apache-2.0
#include "io/vdb_archive.h"

#include "support/files.h"
#include "support/grids.h"
#include "support/shapes.h"
#include "write/hand_made.h"
#include "write/point_grids.h"

#include <gtest/gtest.h>
#include <openvdb/io/File.h>
#include <tbb/global_control.h>

#include <cmath>

namespace vdb_shell
{
namespace
{

namespace fs = std::filesystem;
using openvdb::Coord;
using openvdb::FloatGrid;

/// The bytes without OpenVDB's random UUID.
std::string bytes_without_uuid(const fs::path& path)
{
    std::string bytes = test::read_bytes(path);
    for (std::size_t i = 21; i < 57; ++i)
        bytes.at(i) = '-';
    return bytes;
}

template <class Grid> Grid named(Grid grid, const char* name)
{
    grid->setName(name);
    return grid;
}

/// A leaf for each way in which OpenVDB keeps inactive values, leaves that are full and empty,
/// tiles, several branches, values that do not compress.
FloatGrid::Ptr grid_of_odd_leaves()
{
    auto grid = named(FloatGrid::create(2.5f), "odd");
    const float inactive[][3] = {{2.5f, 2.5f, 2.5f},  {-2.5f, -2.5f, -2.5f}, {7.0f, 7.0f, 7.0f},
                                 {2.5f, -2.5f, 2.5f}, {2.5f, 7.0f, 2.5f},    {7.0f, 9.0f, 7.0f},
                                 {7.0f, 8.0f, 9.0f}};
    int x = -64;
    for (const auto& values : inactive) {
        auto* leaf = grid->tree().touchLeaf(Coord(x, 0, 5000));
        for (openvdb::Index i = 0; i < 512; ++i)
            leaf->setValueOff(i, values[i % 3]);
        for (openvdb::Index i = 0; i < 512; i += 5)
            leaf->setValueOn(i, float(std::sin(double(i) * i)));
        x += 8;
    }
    grid->tree().touchLeaf(Coord(x, 0, 0));
    grid->tree().touchLeaf(Coord(x + 8, 0, 0))->fill(1.0f, true);
    grid->tree().addTile(2, Coord(0, 9000, 0), 3.0f, true);
    grid->tree().addTile(1, Coord(-4096, 0, 0), -3.0f, false);
    return grid;
}

openvdb::GridPtrVec grids_to_write()
{
    const auto made = test::hand_made_shell(test::icosphere(1.0, 3), 0.4, {3, 17});
    const ShellFile file = test::hand_made_file(made, 0.05);
    const PointGrids points = make_point_grids(file.stack, file.tets);
    const auto half = named(file.depth->deepCopy(), "half");
    half->setSaveFloatAsHalf(true);
    const auto odd_half = named(grid_of_odd_leaves(), "odd half");
    odd_half->setSaveFloatAsHalf(true);
    const auto large = test::sphere_level_set(40.0f, 1.0f);
    return {named(file.surface, "surface"),
            named(file.depth, "depth"),
            named(large, "large"),
            half,
            grid_of_odd_leaves(),
            odd_half,
            named(FloatGrid::create(1.0f), "empty"),
            points.points,
            points.prisms,
            points.tets,
            named(openvdb::points::PointDataGrid::create(), "no points")};
}

std::string openvdb_bytes(const openvdb::GridPtrVec& grids, const openvdb::MetaMap& metadata)
{
    const test::TemporaryFolder folder;
    openvdb::io::File file((folder / "expected.vdb").string());
    file.setCompression(openvdb::io::COMPRESS_BLOSC | openvdb::io::COMPRESS_ACTIVE_MASK);
    file.write(grids, metadata);
    file.close();
    return bytes_without_uuid(folder / "expected.vdb");
}

std::string our_bytes(const openvdb::GridPtrVec& grids, const openvdb::MetaMap& metadata)
{
    const test::TemporaryFolder folder;
    write_vdb_archive(folder / "ours.vdb", grids, metadata);
    return bytes_without_uuid(folder / "ours.vdb");
}

TEST(VdbArchive, WritesTheBytesThatOpenVdbWrites)
{
    const openvdb::GridPtrVec grids = grids_to_write();
    for (const openvdb::GridBase::Ptr& grid : grids)
        EXPECT_TRUE(our_bytes({grid}, {}) == openvdb_bytes({grid}, {})) << grid->getName();
    openvdb::MetaMap metadata;
    metadata.insertMeta("creator", openvdb::StringMetadata("a test"));
    EXPECT_TRUE(our_bytes(grids, metadata) == openvdb_bytes(grids, metadata));
}

TEST(VdbArchive, WritesTheSameBytesForAnyNumberOfThreads)
{
    const openvdb::GridPtrVec grids = grids_to_write();
    const auto with_threads = [&](std::size_t threads) {
        const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
        return our_bytes(grids, {});
    };
    const std::string one = with_threads(1);
    EXPECT_TRUE(with_threads(2) == one);
    EXPECT_TRUE(with_threads(5) == one);
}

TEST(VdbArchive, SaysWhenTheFileCannotBeWritten)
{
    const test::TemporaryFolder folder;
    const auto said = [](const fs::path& path) -> std::string {
        try {
            write_vdb_archive(path, grids_to_write(), {});
        } catch (const std::runtime_error& error) {
            return error.what();
        }
        return "nothing";
    };
    EXPECT_EQ(said(folder / "none" / "a.vdb"), "No such file or directory");
    if (fs::exists("/dev/full")) {
        EXPECT_EQ(said("/dev/full"), "No space left on device");
    }
}

} // namespace
} // namespace vdb_shell
