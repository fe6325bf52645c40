// SPDX-License-Identifier: Apache-2.0
#include "core/bucket_sort.h"

#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <functional>

namespace vdb_shell
{
namespace
{

using Item = std::array<std::uint32_t, 2>;

std::vector<Item> mixed_items(std::size_t count, std::uint32_t keys)
{
    std::vector<Item> items;
    for (std::uint32_t i = 0; i < count; ++i)
        items.push_back({i * 7919U % keys, i * 104729U % 1009U});
    return items;
}

std::vector<Item> sorted_by_key(const std::vector<std::vector<Item>>& parts, std::size_t keys)
{
    return bucket_sort<Item>(
        parts, keys, [](const Item& item) { return item[0]; }, std::less<>());
}

// Few columns, and so many that far ones share a number.
TEST(BucketSort, SortsWhatStandsOverColumns)
{
    for (const std::int64_t apart : {1, 1000, 1000000}) {
        std::vector<std::array<std::int64_t, 3>> items;
        for (std::int64_t i = 0; i < 3000; ++i)
            items.push_back({(i * 7919 % 50 - 25) * apart, (i * 104729 % 70 - 35) * apart, i % 11});
        const auto found = bucket_sort_by_column<std::array<std::int64_t, 3>>(
            std::array{items},
            [](const auto& item) {
                return std::array{item[0], item[1]};
            },
            std::less<>());
        std::sort(items.begin(), items.end());
        EXPECT_EQ(found, items) << apart;
    }
    EXPECT_TRUE(bucket_sort_by_column<Item>(
                    std::vector<std::vector<Item>>(),
                    [](const Item& item) {
                        return std::array<std::int64_t, 2>{item[0], item[1]};
                    },
                    std::less<>())
                    .empty());
}

TEST(BucketSort, Sorts)
{
    for (const std::uint32_t keys : {1U, 2U, 100U, 5000U}) {
        std::vector<Item> items = mixed_items(3000, keys);
        const std::vector<Item> found = sorted_by_key({items}, keys);
        std::sort(items.begin(), items.end());
        EXPECT_EQ(found, items) << keys;
    }
}

// So many that several threads take a range of keys each.
TEST(BucketSort, SortsOnSeveralThreads)
{
    for (const std::uint32_t keys : {1U, 3U, 1000U, 70000U}) {
        std::vector<Item> items = mixed_items(50000, keys);
        const std::vector<Item> found = sorted_by_key({items}, keys);
        std::sort(items.begin(), items.end());
        EXPECT_EQ(found, items) << keys;
    }
}

TEST(BucketSort, DoesNotDependOnTheParts)
{
    const std::vector<Item> items = mixed_items(1000, 37);
    const std::vector<Item> whole = sorted_by_key({items}, 37);
    const auto middle = items.begin() + 321;
    EXPECT_EQ(sorted_by_key({{middle, items.end()}, {}, {items.begin(), middle}}, 37), whole);
}

TEST(BucketSort, OfNothingIsNothing)
{
    EXPECT_TRUE(sorted_by_key({}, 0).empty());
    EXPECT_TRUE(sorted_by_key({{}, {}}, 5).empty());
}

} // namespace
} // namespace vdb_shell
