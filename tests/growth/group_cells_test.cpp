// SPDX-License-Identifier: Apache-2.0
#include "growth/group_cells.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <set>

namespace
{

using namespace vdb_shell::growth;

/// Boxes of sides from 0.01 to 1 in a cube of ten.
std::vector<Box> random_boxes(std::size_t count)
{
    std::mt19937 random(7);
    const auto number = [&](double most) { return most * double(random()) / double(random.max()); };
    std::vector<Box> boxes(count);
    for (Box& box : boxes) {
        const Vec3d at(number(10), number(10), number(10));
        const double size = std::pow(10.0, -number(2));
        box.add(at);
        box.add(at + size * Vec3d(1, number(1), number(1)));
    }
    return boxes;
}

bool apart(const Box& a, const Box& b)
{
    for (int k = 0; k < 3; ++k)
        if (a.hi[k] < b.lo[k] || b.hi[k] < a.lo[k])
            return true;
    return false;
}

TEST(GroupCells, EachGroupIsInOneCellWhoseDomainHoldsIt)
{
    const std::vector<Box> boxes = random_boxes(2000);
    std::multiset<std::size_t> seen;
    for (const GroupTurn& turn : turns_of_groups(boxes))
        for (const GroupCell& cell : turn)
            for (const std::size_t i : cell.groups) {
                seen.insert(i);
                EXPECT_TRUE(cell.domain.contains(boxes[i].lo)) << i;
                EXPECT_TRUE(cell.domain.contains(boxes[i].hi)) << i;
            }
    EXPECT_EQ(seen.size(), boxes.size());
    EXPECT_EQ(std::set<std::size_t>(seen.begin(), seen.end()).size(), boxes.size());
}

TEST(GroupCells, DomainsOfATurnHaveNoCommonPoint)
{
    const std::vector<GroupTurn> turns = turns_of_groups(random_boxes(2000));
    std::size_t most = 0;
    for (const GroupTurn& turn : turns) {
        most = std::max(most, turn.size());
        for (std::size_t i = 0; i < turn.size(); ++i)
            for (std::size_t j = 0; j < i; ++j)
                EXPECT_TRUE(apart(turn[i].domain, turn[j].domain));
    }
    // There would be nothing to do at the same time with one cell a turn.
    EXPECT_GT(most, 10u);
}

TEST(GroupCells, GroupsOfACellAreInOrder)
{
    std::size_t looked_at = 0, most = 0;
    for (const GroupTurn& turn : turns_of_groups(random_boxes(500)))
        for (const GroupCell& cell : turn) {
            EXPECT_TRUE(std::is_sorted(cell.groups.begin(), cell.groups.end()));
            looked_at += cell.groups.size();
            most = std::max(most, cell.groups.size());
        }
    EXPECT_EQ(looked_at, 500u);
    // A group that is alone in its cell is in order whatever is done.
    EXPECT_GT(most, 1u);
}

} // namespace
