// SPDX-License-Identifier: Apache-2.0
#include "io/vdb_grids.h"

#include "support/files.h"
#include "support/grids.h"

#include <gtest/gtest.h>
#include <openvdb/io/File.h>

#include <new>
#include <stdexcept>

namespace vdb_shell::test
{
namespace
{

openvdb::GridPtrVec some_grids()
{
    const auto half = sphere_level_set(1, 0.5f);
    half->setName("ball");
    half->setSaveFloatAsHalf(true);
    return {half, empty_grid("int32", "twice"), empty_grid("vec3s", "twice")};
}

TEST(VdbGrids, AreListedWithTypeAndClass)
{
    openvdb::initialize();
    EXPECT_EQ(list_of(some_grids()),
              "\"ball\" (float as half, level set), \"twice\" (int32, unknown), \"twice\" "
              "(vec3s, unknown)");
    EXPECT_EQ(list_of({}), "no grids");
}

TEST(VdbGrids, AreFoundByANameThatOneAloneHas)
{
    openvdb::initialize();
    const openvdb::GridPtrVec grids = some_grids();
    EXPECT_EQ(grid_of_name(grids, "ball", "in.vdb"), grids[0]);
    EXPECT_NE(complaint_of([&] {
                  grid_of_name(grids, "twice", "in.vdb");
              }).find("in.vdb: has two grids of the name \"twice\""),
              std::string::npos);
    EXPECT_NE(complaint_of([&] {
                  grid_of_name(grids, "none", "in.vdb");
              }).find("in.vdb: has no grid \"none\"; it has \"ball\""),
              std::string::npos);
}

TEST(VdbGrids, WhatDecodersThrowBecomesAReadErrorOfTheFile)
{
    const TemporaryFolder folder;
    const auto path = folder / "in.vdb";
    openvdb::initialize();
    openvdb::io::File file(path.string());
    file.write(some_grids());
    file.close();
    EXPECT_EQ(reading_vdb(path, [] { return 7; }), 7);
    EXPECT_NE(complaint_of([&] {
                  reading_vdb(path, [] { throw std::runtime_error("a damaged leaf"); });
              }).find("in.vdb: cannot be read: a damaged leaf"),
              std::string::npos);
    // Said of the option, and of the machine, not of the file.
    EXPECT_THROW(reading_vdb(path, [] { throw InvalidOption("no"); }), InvalidOption);
    EXPECT_THROW(reading_vdb(path, [] { throw std::bad_alloc(); }), std::bad_alloc);
    bool asked = false;
    write_bytes(path, "no .vdb");
    EXPECT_THROW(reading_vdb(path, [&] { asked = true; }), ReadError);
    EXPECT_FALSE(asked);
}

} // namespace
} // namespace vdb_shell::test
