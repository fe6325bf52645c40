// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <vector>

namespace vdb_shell
{

/// Sets of the numbers from 0 on, joined two by two (union-find). The root of a set is its smallest
/// number, whatever the order of the joins, so what is numbered by roots depends on no threads.
class DisjointSets
{
public:
    /// Each number alone.
    explicit DisjointSets(std::size_t count) : parent_(count)
    {
        std::iota(parent_.begin(), parent_.end(), 0U);
    }

    std::uint32_t root_of(std::uint32_t i)
    {
        // Paths are halved on the way, so that later searches are short: nearly linear in all.
        while (parent_[i] != i)
            i = parent_[i] = parent_[parent_[i]];
        return i;
    }

    /// Whether they were in two sets.
    bool join(std::uint32_t a, std::uint32_t b)
    {
        a = root_of(a);
        b = root_of(b);
        parent_[std::max(a, b)] = std::min(a, b);
        return a != b;
    }

private:
    std::vector<std::uint32_t> parent_;
};

} // namespace vdb_shell
