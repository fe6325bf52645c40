// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/parallel.h"

#include <algorithm>
#include <cstddef>

namespace vdb_shell
{

/// For counting and listing by key, a number below `keys`, on several threads: calls visit(begin,
/// end) for disjoint ranges of keys. Each call looks at all items and takes those of its range,
/// in their order, so lists are those that one thread makes. Items are read one after the other;
/// what takes time are writes to places far apart, and these are shared.
template <class Visit>
void for_each_key_range(std::size_t keys, std::size_t items, const Visit& visit)
{
    // With few items a second thread costs more than it saves; more than a few threads would read
    // more than they write.
    constexpr std::size_t kFewItems = 1 << 14, kMostRanges = 4;
    const std::size_t ranges = items < kFewItems ? 1 : std::min(thread_count(), kMostRanges);
    for_each_index(
        ranges,
        [&](std::size_t range) { visit(keys * range / ranges, keys * (range + 1) / ranges); }, 1);
}

} // namespace vdb_shell
