// SPDX-License-Identifier: Apache-2.0
#include "write/point_grid_builder.h"

#include "core/grid_instances.h"
#include "write/point_grids.h"

#include <gtest/gtest.h>
#include <openvdb/points/AttributeArray.h>
#include <openvdb/points/AttributeGroup.h>

#include <cmath>
#include <string>
#include <vector>

namespace
{

using namespace vdb_shell;
using openvdb::Vec3s;

/// OpenVDB has to know the types of attributes.
class PointGridBuilderTest : public testing::Test
{
protected:
    static void SetUpTestSuite() { openvdb::initialize(); }
};

/// Calls visit(leaf, row, id) for each point.
template <typename Visit>
void for_each_point(const openvdb::points::PointDataGrid& grid, const Visit& visit)
{
    for (auto leaf = grid.tree().cbeginLeaf(); leaf; ++leaf) {
        const openvdb::points::AttributeHandle<std::int32_t> id(leaf->constAttributeArray("id"));
        for (openvdb::Index row = 0; row < id.size(); ++row)
            visit(*leaf, row, std::size_t(id.get(row)));
    }
}

/// Points along a line, in an order that is not that of the voxels.
std::vector<Vec3s> scattered(std::size_t count)
{
    std::vector<Vec3s> points;
    for (std::size_t i = 0; i < count; ++i)
        points.emplace_back(float(7 * i % count), 0.0F, 1.0F);
    return points;
}

std::vector<std::int32_t> numbers(std::size_t count)
{
    std::vector<std::int32_t> all(count);
    for (std::size_t i = 0; i < count; ++i)
        all[i] = std::int32_t(i);
    return all;
}

TEST_F(PointGridBuilderTest, EveryPointHasItsRowOfEachColumn)
{
    const std::vector<Vec3s> points = scattered(100);
    PointGridBuilder builder("g", points);
    builder.add("id", numbers(100));
    std::vector<float> zeros(100, 0.0F);
    for (std::size_t i = 0; i < 100; i += 2)
        zeros[i] = -0.0F;
    builder.add("zero", zeros);
    builder.add("rest", points);
    builder.add_tuples("pair", 2, [](std::size_t k) { return k; });
    const auto grid = builder.take();
    EXPECT_EQ(grid->getName(), "g");
    std::size_t count = 0;
    for_each_point(*grid, [&](const auto& leaf, openvdb::Index row, std::size_t id) {
        using namespace openvdb::points;
        ++count;
        const AttributeHandle<float> zero(leaf.constAttributeArray("zero"));
        EXPECT_EQ(std::signbit(zero.get(row)), id % 2 == 0);
        const AttributeHandle<Vec3s> rest(leaf.constAttributeArray("rest"));
        EXPECT_TRUE(same_bits(rest.get(row), points[id]));
        const AttributeHandle<std::int32_t> pair(leaf.constAttributeArray("pair"));
        const AttributeHandle<std::int32_t> second(leaf.constAttributeArray("pair1"));
        EXPECT_EQ(pair.get(row, 0), std::int32_t(2 * id));
        EXPECT_EQ(pair.get(row, 1), std::int32_t(2 * id + 1));
        EXPECT_EQ(second.get(row), std::int32_t(2 * id + 1));
    });
    EXPECT_EQ(count, points.size());
}

TEST_F(PointGridBuilderTest, GroupsHoldTheirMembers)
{
    PointGridBuilder builder("g", scattered(30));
    builder.add("id", numbers(30));
    std::vector<short> third(30);
    for (std::size_t i = 0; i < 30; i += 3)
        third[i] = 1;
    builder.add_group("third", third);
    for_each_point(*builder.take(), [](const auto& leaf, openvdb::Index row, std::size_t id) {
        EXPECT_EQ(leaf.groupHandle("third").get(row), id % 3 == 0);
    });
}

TEST_F(PointGridBuilderTest, NoPointsMakeAGridWithoutLeaves)
{
    PointGridBuilder builder("g", {});
    builder.add("id", std::vector<std::int32_t>{});
    builder.add_group("none", {});
    EXPECT_TRUE(builder.take()->tree().empty());
}

} // namespace
