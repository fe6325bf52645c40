// SPDX-License-Identifier: Apache-2.0
#include "vdb_shell/write/remesh_map.h"

#include "vdb_shell/core/error.h"

#include "support/files.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <vector>

namespace vdb_shell::test
{
namespace
{

RemeshMap some_map()
{
    return {{{4, {7, 8, 9}, {0.1, 0.2, 0.7}}, {0, {0, 1, 2}, {1, 0, 0}}},
            {{2, {3, 4, 5}, {0.25, 0.5, 0.25}}}};
}

TEST(RemeshMapFile, JsonHoldsEveryDigit)
{
    const TemporaryFolder folder;
    const auto path = folder / "map.json";
    write_remesh_map(path, some_map());
    const auto json = nlohmann::json::parse(read_bytes(path));
    const auto& there = json.at("input_on_result");
    EXPECT_EQ(there.at("triangle"), (std::vector<int>{4, 0}));
    EXPECT_EQ(there.at("corners"), (std::vector<std::vector<int>>{{7, 8, 9}, {0, 1, 2}}));
    EXPECT_EQ(there.at("weights"), (std::vector<std::vector<double>>{{0.1, 0.2, 0.7}, {1, 0, 0}}));
    EXPECT_EQ(json.at("result_on_input").at("triangle"), std::vector<int>{2});
}

TEST(RemeshMapFile, CsvHasARowForEachVertex)
{
    const TemporaryFolder folder;
    const auto path = folder / "map.csv";
    write_remesh_map(path, some_map());
    EXPECT_EQ(read_bytes(path),
              "map,vertex,triangle,corner0,corner1,corner2,weight0,weight1,weight2\n"
              "input_on_result,0,4,7,8,9,0.1,0.2,0.7\n"
              "input_on_result,1,0,0,1,2,1,0,0\n"
              "result_on_input,0,2,3,4,5,0.25,0.5,0.25\n");
}

TEST(RemeshMapFile, OtherExtensionsAreRefused)
{
    EXPECT_THROW(require_map_extension("map.txt"), InvalidOption);
    EXPECT_THROW(write_remesh_map("map", some_map()), InvalidOption);
    EXPECT_NO_THROW(require_map_extension("MAP.CSV"));
}

} // namespace
} // namespace vdb_shell::test
