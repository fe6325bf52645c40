// SPDX-License-Identifier: Apache-2.0
#include "core/propose_in_blocks.h"

#include <gtest/gtest.h>

#include <array>
#include <vector>

namespace
{

using namespace vdb_shell;

TEST(ProposeInBlocks, MakesInOrderWhatWasProposedOnTheStateOfItsBlocksBeginning)
{
    constexpr std::size_t kCount = 100, kBlock = 16;
    std::size_t made = 0, begun = 0;
    std::array<std::size_t, kBlock> seen{};
    std::vector<std::size_t> order;
    propose_in_blocks(
        kCount, kBlock, [&] { ++begun; },
        [&](std::size_t item, std::size_t slot) {
            EXPECT_EQ(slot, item % kBlock);
            seen[slot] = made;
        },
        [&](std::size_t item, std::size_t slot) {
            EXPECT_EQ(seen[slot], item / kBlock * kBlock);
            order.push_back(item);
            ++made;
        });
    EXPECT_EQ(begun, 7u);
    ASSERT_EQ(order.size(), kCount);
    for (std::size_t i = 0; i < kCount; ++i)
        EXPECT_EQ(order[i], i);
}

TEST(ProposeInBlocks, NothingIsDoneForNothing)
{
    propose_in_blocks(
        0, 8, [] { FAIL(); }, [](std::size_t, std::size_t) { FAIL(); },
        [](std::size_t, std::size_t) { FAIL(); });
}

} // namespace
