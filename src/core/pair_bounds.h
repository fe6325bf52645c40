// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>

namespace vdb_shell
{

/// Where a search for pairs may end early: n items that all meet have n^2 / 2 pairs, and to list
/// them takes as long, however they are found. Nothing is left out if nothing is said.
struct PairBounds {
    /// Whether no more is asked about an item. Pairs of two such may be left out. It may become
    /// true while pairs are sought, of each of a pair that keep() has just been called for, and is
    /// called from several threads.
    std::function<bool(std::uint32_t)> settled;
    /// Whether pairs of a crowd are listed to about most_of its items only, the same for any number
    /// of threads.
    bool limited = false;

    /// All pairs of 1,448 items, and of more so many that the list is no longer than some for each
    /// item: a surface of use has fewer by far, and these are a second's work.
    std::size_t most_of(std::size_t items) const
    {
        constexpr std::size_t kPairs = std::size_t(1) << 20, kPairsEach = 16;
        return limited ? kPairs + kPairsEach * items : SIZE_MAX;
    }
    bool both_settled(std::uint32_t first, std::uint32_t second) const
    {
        return settled && settled(first) && settled(second);
    }
};

} // namespace vdb_shell
