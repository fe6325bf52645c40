// SPDX-License-Identifier: Apache-2.0
#include "core/disjoint_sets.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <vector>

namespace
{

using vdb_shell::DisjointSets;

TEST(DisjointSets, RootsAreTheSmallestNumbersInAnyOrderOfJoins)
{
    // A chain of six, a pair and one alone.
    std::vector<std::array<std::uint32_t, 2>> joins{{7, 3}, {3, 5}, {5, 2}, {2, 9}, {9, 8}, {6, 1}};
    const std::vector<std::uint32_t> roots{0, 1, 2, 2, 4, 2, 1, 2, 2, 2};
    std::sort(joins.begin(), joins.end());
    do {
        DisjointSets sets(roots.size());
        for (const auto& [a, b] : joins)
            EXPECT_TRUE(sets.join(a, b));
        for (const auto& [a, b] : joins)
            EXPECT_FALSE(sets.join(b, a)) << "they are in one set already";
        for (std::uint32_t i = 0; i < roots.size(); ++i)
            ASSERT_EQ(sets.root_of(i), roots[i]);
    } while (std::next_permutation(joins.begin(), joins.end()));
}

} // namespace
