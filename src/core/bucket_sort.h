// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/key_ranges.h"
#include "core/parallel.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

namespace vdb_shell
{

/// All items of all parts, sorted by key(item), a number below `keys`, and by `less` among equal
/// keys: a bucket for each key, sorted in itself. Much faster than a sort where no key has many
/// items, as with the smallest vertex of an edge or a face. The result does not depend on how the
/// items are spread over the parts if `less` tells all items of a key apart.
template <typename Item, typename Parts, typename Key, typename Less>
std::vector<Item> bucket_sort(const Parts& parts, std::size_t keys, const Key& key,
                              const Less& less)
{
    // By key first the numbers, then the starts, then the ends.
    std::vector<std::size_t> ends(keys + 1, 0);
    std::size_t count = 0;
    for (const std::vector<Item>& part : parts)
        count += part.size();
    /// Calls take(key, item) for all items, in their order for each key.
    const auto for_each_item = [&](const auto& take) {
        for_each_key_range(keys, count, [&](std::size_t first, std::size_t last) {
            for (const std::vector<Item>& part : parts)
                for (const Item& item : part)
                    // Keys before the first wrap around.
                    if (const auto k = std::size_t(key(item)); k - first < last - first)
                        take(k, item);
        });
    };
    for_each_item([&](std::size_t k, const Item&) { ++ends[k + 1]; });
    for (std::size_t k = 0; k < keys; ++k)
        ends[k + 1] += ends[k];
    std::vector<Item> items(count);
    for_each_item([&](std::size_t k, const Item& item) { items[ends[k]++] = item; });
    for_each_index(keys, [&](std::size_t k) {
        const auto begin = items.begin() + std::ptrdiff_t(k == 0 ? 0 : ends[k - 1]);
        const auto end = items.begin() + std::ptrdiff_t(ends[k]);
        // Parts that list their items in order leave nothing to sort; to look costs little.
        if (!std::is_sorted(begin, end, less))
            std::sort(begin, end, less);
    });
    return items;
}

/// The same where place(item), two whole numbers, says over which column an item stands: by the
/// first, the second and `less`, which has to put items in that order by itself.
template <typename Item, typename Parts, typename Place, typename Less>
std::vector<Item> bucket_sort_by_column(const Parts& parts, const Place& place, const Less& less)
{
    using Column = std::array<std::int64_t, 2>;
    constexpr std::int64_t kNone = std::numeric_limits<std::int64_t>::max();
    Column low{kNone, kNone}, high{-kNone, -kNone};
    for (const std::vector<Item>& part : parts)
        for (const Item& item : part) {
            const Column at = place(item);
            for (std::size_t k = 0; k < 2; ++k)
                low[k] = std::min(low[k], at[k]), high[k] = std::max(high[k], at[k]);
        }
    if (low[0] > high[0])
        return {};
    // Columns by number, many far apart sharing one.
    constexpr std::int64_t kMostKeys = 1 << 16;
    const std::int64_t width = high[1] - low[1] + 1, columns = (high[0] - low[0] + 1) * width;
    const std::int64_t columns_to_a_key = 1 + columns / kMostKeys;
    return bucket_sort<Item>(
        parts, std::size_t(columns / columns_to_a_key + 1),
        [&](const Item& item) {
            const Column at = place(item);
            return ((at[0] - low[0]) * width + (at[1] - low[1])) / columns_to_a_key;
        },
        less);
}

} // namespace vdb_shell
