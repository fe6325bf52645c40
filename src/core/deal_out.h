// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/parallel.h"

#include <algorithm>
#include <cstddef>
#include <vector>

namespace vdb_shell
{

/// All items of all parts, sorted by key(item), a number below `keys`, and by `less` among equal
/// keys: dealt out by key and sorted in their heaps. Much faster than a sort where no key has many
/// items, as with the smallest vertex of an edge or a face. The result does not depend on how the
/// items are spread over the parts if `less` tells all items of a key apart.
template <typename Item, typename Parts, typename Key, typename Less>
std::vector<Item> deal_out(const Parts& parts, std::size_t keys, const Key& key, const Less& less)
{
    // By key first the numbers, then the starts, then the ends.
    std::vector<std::size_t> ends(keys + 1, 0);
    for (const std::vector<Item>& part : parts)
        for (const Item& item : part)
            ++ends[std::size_t(key(item)) + 1];
    for (std::size_t k = 0; k < keys; ++k)
        ends[k + 1] += ends[k];
    std::vector<Item> items(ends.back());
    for (const std::vector<Item>& part : parts)
        for (const Item& item : part)
            items[ends[std::size_t(key(item))]++] = item;
    for_each_index(keys, [&](std::size_t k) {
        std::sort(items.begin() + std::ptrdiff_t(k == 0 ? 0 : ends[k - 1]),
                  items.begin() + std::ptrdiff_t(ends[k]), less);
    });
    return items;
}

} // namespace vdb_shell
