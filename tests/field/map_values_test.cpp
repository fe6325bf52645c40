// SPDX-License-Identifier: Apache-2.0
#include "field/map_values.h"

#include <gtest/gtest.h>

namespace vdb_shell
{
namespace
{

using openvdb::Coord;

TEST(map_values, changes_voxels_tiles_of_every_level_and_the_background)
{
    openvdb::initialize();
    auto grid = openvdb::FloatGrid::create(5.0F);
    openvdb::FloatTree& tree = grid->tree();
    tree.setValueOn(Coord(1, 2, 3), 1.0F);
    tree.setValueOff(Coord(1, 2, 4), 2.0F);
    tree.addTile(1, Coord(64, 0, 0), 3.0F, true);
    tree.addTile(2, Coord(0, 256, 0), 4.0F, false);
    tree.addTile(3, Coord(0, 0, 8192), 6.0F, true);
    const openvdb::Index64 active = tree.activeVoxelCount();
    map_values(tree, [](float value) { return 10 - value; });
    EXPECT_EQ(tree.getValue(Coord(1, 2, 3)), 9.0F);
    EXPECT_EQ(tree.getValue(Coord(1, 2, 4)), 8.0F);
    EXPECT_EQ(tree.getValue(Coord(1, 2, 5)), 5.0F);
    EXPECT_EQ(tree.getValue(Coord(64, 0, 0)), 7.0F);
    EXPECT_EQ(tree.getValue(Coord(0, 256, 0)), 6.0F);
    EXPECT_EQ(tree.getValue(Coord(0, 0, 8192)), 4.0F);
    EXPECT_EQ(tree.getValue(Coord(-100000, 0, 0)), 5.0F);
    EXPECT_EQ(tree.background(), 5.0F);
    EXPECT_EQ(tree.activeVoxelCount(), active);
    map_values(tree, [](float value) { return value + 1; });
    EXPECT_EQ(tree.background(), 6.0F);
    EXPECT_EQ(tree.getValue(Coord(-100000, 0, 0)), 6.0F);
    EXPECT_EQ(tree.getValue(Coord(1, 2, 3)), 10.0F);
}

} // namespace
} // namespace vdb_shell
