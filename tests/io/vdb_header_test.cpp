// SPDX-License-Identifier: Apache-2.0
#include "vdb_shell/io/vdb_header.h"

#include "vdb_shell/core/error.h"

#include "io/vdb_archive.h"
#include "support/files.h"
#include "support/grids.h"
#include "support/shapes.h"
#include "write/hand_made.h"
#include "write/point_grids.h"

#include <gtest/gtest.h>
#include <openvdb/io/File.h>
#include <openvdb/io/Stream.h>

#include <cstring>
#include <limits>
#include <random>
#include <sstream>

namespace vdb_shell
{
namespace
{

namespace fs = std::filesystem;
using openvdb::Coord;
using openvdb::FloatGrid;
using openvdb::GridBase;
using openvdb::GridPtrVec;
using namespace openvdb::io;

template <typename Pointer> Pointer named(const Pointer& grid, const std::string& name)
{
    grid->setName(name);
    return grid;
}

/// Leaves with all kinds of inactive values, tiles on all levels, several branches.
template <typename Grid = FloatGrid> typename Grid::Ptr odd_grid()
{
    using Value = typename Grid::ValueType;
    const auto value = [](double x) { return Value(static_cast<float>(x)); };
    auto grid = named(Grid::create(value(2.5)), "odd");
    const double inactive[][3] = {{2.5, 2.5, 2.5}, {-2.5, -2.5, -2.5}, {7.0, 7.0, 7.0},
                                  {2.5, 7.0, 2.5}, {7.0, 9.0, 7.0},    {7.0, 8.0, 9.0}};
    int x = -64;
    for (const auto& values : inactive) {
        auto* leaf = grid->tree().touchLeaf(Coord(x, 0, 5000));
        for (openvdb::Index i = 0; i < 512; ++i)
            leaf->setValueOff(i, value(values[i % 3]));
        for (openvdb::Index i = 0; i < 512; i += 5)
            leaf->setValueOn(i, value(i * 0.37));
        x += 8;
    }
    grid->tree().touchLeaf(Coord(x, 0, 0));
    grid->tree().touchLeaf(Coord(x + 8, 0, 0))->fill(value(1.0), true);
    grid->tree().addTile(3, Coord(0, -90000, 0), value(4.0), true);
    grid->tree().addTile(2, Coord(0, 9000, 0), value(3.0), true);
    grid->tree().addTile(1, Coord(-4096, 0, 0), value(-3.0), false);
    return grid;
}

/// Vectors, with half floats too, and whole numbers, which the mark of half floats does not change.
GridPtrVec grids_of_other_values()
{
    GridPtrVec grids{named(odd_grid<openvdb::Vec3SGrid>(), "vectors"),
                     named(odd_grid<openvdb::Vec3SGrid>(), "half vectors"),
                     named(odd_grid<openvdb::Int32Grid>(), "numbers"),
                     named(odd_grid<openvdb::Int32Grid>(), "numbers marked as half")};
    grids[1]->setSaveFloatAsHalf(true);
    grids[3]->setSaveFloatAsHalf(true);
    return grids;
}

GridPtrVec points_and_floats()
{
    const auto made = test::hand_made_shell(test::icosphere(1.0, 1), 0.4, {3, 7});
    const ShellFile file = test::hand_made_file(made, 0.3);
    const PointGrids points = make_point_grids(file.stack, file.tets);
    GridPtrVec grids{odd_grid(), named(file.surface, "surface"), points.points, points.prisms,
                     points.tets};
    for (const GridBase::Ptr& grid : grids_of_other_values())
        grids.push_back(grid);
    return grids;
}

std::string bytes_by_openvdb(const GridPtrVec& grids, std::uint32_t compression)
{
    const test::TemporaryFolder folder;
    File file((folder / "a.vdb").string());
    file.setCompression(compression);
    file.write(grids, openvdb::MetaMap());
    file.close();
    return test::read_bytes(folder / "a.vdb");
}

/// What the walk says; empty where it lets the bytes pass.
std::string complaint(const std::string& bytes)
{
    try {
        require_whole_vdb(bytes, "a.vdb");
    } catch (const ReadError& error) {
        return error.what();
    }
    return {};
}

/// Decodes the grids of all types that are walked whole.
void decode(const std::string& bytes)
{
    const test::TemporaryFolder folder;
    test::write_bytes(folder / "a.vdb", bytes);
    File file((folder / "a.vdb").string());
    file.open(false);
    const openvdb::GridPtrVecPtr all = file.readAllGridMetadata();
    for (auto name = file.beginName(); name != file.endName(); ++name) {
        const std::string type = file.readGridMetadata(*name)->type();
        if (type == openvdb::BoolGrid::gridType())
            continue;
        const GridBase::Ptr grid = file.readGrid(*name);
        // Goes over all nodes.
        EXPECT_GT(grid->memUsage(), 0u);
        EXPECT_LT(grid->activeVoxelCount(), std::numeric_limits<openvdb::Index64>::max());
    }
}

constexpr std::uint32_t kAllCompressions[] = {
    COMPRESS_NONE,  COMPRESS_ACTIVE_MASK,
    COMPRESS_ZIP,   COMPRESS_ZIP | COMPRESS_ACTIVE_MASK,
    COMPRESS_BLOSC, COMPRESS_BLOSC | COMPRESS_ACTIVE_MASK};

TEST(VdbHeader, WhatOpenVdbWritesPasses)
{
    GridPtrVec grids = points_and_floats();
    auto half = named(odd_grid(), "half");
    half->setSaveFloatAsHalf(true);
    grids.push_back(half);
    grids.push_back(named(FloatGrid::create(1.0f), "empty"));
    grids.push_back(openvdb::points::PointDataGrid::create());
    grids.back()->setName("no points");
    grids.push_back(openvdb::Vec3SGrid::create(openvdb::Vec3s(1.0f)));
    grids.push_back(openvdb::BoolGrid::create(true));
    auto frustum = named(odd_grid(), "frustum");
    frustum->setTransform(openvdb::math::Transform::createFrustumTransform(
        openvdb::BBoxd(openvdb::Vec3d(0.0), openvdb::Vec3d(10.0)), 0.5, 10.0, 1.0));
    grids.push_back(frustum);
    for (const std::uint32_t compression : kAllCompressions) {
        const std::string bytes = bytes_by_openvdb(grids, compression);
        EXPECT_EQ(complaint(bytes), "") << compression;
        decode(bytes);
    }
}

TEST(VdbHeader, GridsThatShareATreePassAndMayNotBeOfTwoTypes)
{
    const auto one = odd_grid();
    const auto other = named(one->copy(), "copy");
    const std::string bytes = bytes_by_openvdb({one, other}, COMPRESS_BLOSC);
    EXPECT_EQ(complaint(bytes), "");
    std::string changed = bytes;
    const std::string type = "Tree_float_5_4_3";
    changed.replace(changed.find(type), type.size(), "Tree_int32_5_4_3");
    EXPECT_NE(complaint(changed).find("of another type"), std::string::npos) << complaint(changed);
}

/// The number in front of a block is how much OpenVDB 10 reads into a node before it compares.
TEST(VdbHeader, BlocksThatOverflowTheirNode)
{
    auto grid = named(FloatGrid::create(0.0f), "a");
    auto* leaf = grid->tree().touchLeaf(Coord(0));
    for (openvdb::Index i = 0; i < 512; ++i)
        leaf->setValueOn(i, float(i * i % 977) * 0.1f);
    for (const std::uint32_t compression : {COMPRESS_BLOSC, COMPRESS_ZIP}) {
        const std::string bytes = bytes_by_openvdb({grid}, compression);
        EXPECT_EQ(complaint(bytes), "");
        // The block of the only leaf stands last.
        std::size_t place = bytes.size() - 8;
        std::int64_t size = 0;
        while (size != std::int64_t(bytes.size() - place - 8) || size < 16)
            std::memcpy(&size, &bytes[--place], sizeof size);
        for (const std::int64_t wrong : {std::int64_t(-1000000), std::int64_t(1) << 40, size - 1,
                                         size + 1, std::int64_t(-2048), INT64_MIN}) {
            std::string changed = bytes;
            std::memcpy(&changed[place], &wrong, sizeof wrong);
            EXPECT_NE(complaint(changed), "") << wrong;
        }
    }
}

/// OpenVDB 10 leaks a node whose own values it cannot read.
TEST(VdbHeader, TileValuesThatDoNotDecompress)
{
    auto grid = named(FloatGrid::create(0.0f), "a");
    for (int i = 0; i < 16; ++i)
        grid->tree().addTile(2, Coord(0, 128 * i, 0), float(i % 5), true);
    for (const std::uint32_t compression : {COMPRESS_BLOSC, COMPRESS_ZIP}) {
        const std::string bytes = bytes_by_openvdb({grid}, compression);
        EXPECT_EQ(complaint(bytes), "");
        // With no leaf, the file ends with the block of the only node.
        std::size_t place = bytes.size() - 8;
        std::int64_t size = 0;
        while (size != std::int64_t(bytes.size() - place - 8) || size < 16)
            std::memcpy(&size, &bytes[--place], sizeof size);
        std::string changed = bytes;
        // Behind the header of a chunk of Blosc, and of a stream of zlib.
        for (std::size_t i = place + 8 + 20; i < bytes.size(); ++i)
            changed[i] = '\xff';
        EXPECT_NE(complaint(changed).find("does not decompress"), std::string::npos)
            << compression << ": " << complaint(changed);
    }
}

/// OpenVDB 10 passes over white space in a UUID, and reads on behind it in another place.
TEST(VdbHeader, UuidsThatAreNone)
{
    constexpr std::size_t kUuid = 21;
    const std::string bytes = bytes_by_openvdb({odd_grid()}, COMPRESS_BLOSC);
    for (const std::size_t at : {0u, 5u, 12u, 23u, 35u})
        for (const char wrong : {'\f', ' ', 'g', '\0'}) {
            std::string changed = bytes;
            changed[kUuid + at] = wrong;
            EXPECT_NE(complaint(changed).find("UUID"), std::string::npos) << at;
            // One byte more instead of another.
            changed = bytes;
            changed.insert(kUuid + at, 1, wrong);
            EXPECT_NE(complaint(changed).find("UUID"), std::string::npos) << at;
        }
}

TEST(VdbHeader, StreamsWithoutPlacesOfGrids)
{
    std::ostringstream out;
    Stream(out).write(GridPtrVec{odd_grid()});
    EXPECT_NE(complaint(out.str()).find("stream"), std::string::npos);
}

TEST(VdbHeader, CutAnywhere)
{
    const std::string bytes =
        bytes_by_openvdb(points_and_floats(), COMPRESS_BLOSC | COMPRESS_ACTIVE_MASK);
    for (std::size_t size = 0; size < bytes.size(); size += 1 + size / 50)
        EXPECT_NE(complaint(bytes.substr(0, size)), "") << size;
}

/// What passes has to be decoded without a crash; a sanitizer sees more.
void flip_bits(std::uint32_t compression, std::size_t flips, int bits)
{
    const std::string bytes = bytes_by_openvdb(points_and_floats(), compression);
    std::mt19937_64 random(compression + 10 * std::uint32_t(bits));
    std::size_t passed = 0;
    for (std::size_t i = 0; i < flips; ++i) {
        std::string changed = bytes;
        for (int k = 0; k < bits; ++k) {
            const std::size_t bit = random() % (8 * bytes.size());
            changed[bit / 8] = char(changed[bit / 8] ^ (1 << bit % 8));
        }
        if (!complaint(changed).empty())
            continue;
        ++passed;
        try {
            decode(changed);
        } catch (const std::exception&) {
            // What the walk leaves to OpenVDB it refuses with an exception.
        }
    }
    EXPECT_LT(passed, flips);
}

TEST(VdbHeader, FlippedBitsCannotCrashTheDecoder)
{
    for (const std::uint32_t compression : kAllCompressions) {
        flip_bits(compression, 200, 1);
        flip_bits(compression, 100, 4);
    }
}

} // namespace
} // namespace vdb_shell
