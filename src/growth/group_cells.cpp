// SPDX-License-Identifier: Apache-2.0

// Takes: the boxes of groups. Leaves: turns of cells. A cell's domain is its cube and a little less
// than half a cube more on all sides, and two cubes of one colour have a cube between them, so
// their domains have no common point. A group belongs to the cube that its middle is in.

#include "growth/group_cells.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <tuple>
#include <utility>

namespace vdb_shell::growth
{
namespace
{

// Edge of a cube over the longest side of a group's box, at least. The box of a group whose middle
// lies on the cube's boundary then still keeps within the domain.
constexpr double kSizes = 1.1;
// What a domain has more than its cube on each side, in edges. With half an edge domains would
// touch each other.
constexpr double kCellMargin = 0.49;

double longest_side(const Box& box)
{
    const Vec3d size = box.hi - box.lo;
    return std::max({size[0], size[1], size[2]});
}

using Place = std::array<std::int64_t, 3>;

unsigned colour_of(const Place& place)
{
    return unsigned(place[0] & 1) | unsigned(place[1] & 1) << 1 | unsigned(place[2] & 1) << 2;
}

Box domain_of(const Place& place, double edge)
{
    Box box;
    for (int k = 0; k < 3; ++k) {
        const auto at = double(place[std::size_t(k)]);
        box.lo[k] = (at - kCellMargin) * edge;
        box.hi[k] = (at + 1 + kCellMargin) * edge;
    }
    return box;
}

} // namespace

std::vector<GroupTurn> turns_of_groups(const std::vector<Box>& boxes)
{
    // By size, the largest first, colour and place. Large steps first: with small ones first the
    // scan boot ended at .9711 of the solid, with large ones at .9740.
    std::map<std::tuple<int, unsigned, Place>, std::vector<std::size_t>> cells;
    for (std::size_t i = 0; i < boxes.size(); ++i) {
        const double wanted = kSizes * longest_side(boxes[i]);
        if (!(wanted > 0))
            continue;
        const int exponent = std::ilogb(wanted) + 1;
        const double edge = std::ldexp(1.0, exponent);
        const Vec3d middle = 0.5 * (boxes[i].lo + boxes[i].hi);
        Place place{};
        for (int k = 0; k < 3; ++k)
            place[std::size_t(k)] = std::int64_t(std::floor(middle[k] / edge));
        cells[{-exponent, colour_of(place), place}].push_back(i);
    }
    std::vector<GroupTurn> turns;
    std::tuple<int, unsigned> last;
    for (auto& [key, groups] : cells) {
        const auto& [size, colour, place] = key;
        if (turns.empty() || last != std::tuple(size, colour))
            turns.emplace_back();
        last = {size, colour};
        turns.back().push_back({domain_of(place, std::ldexp(1.0, -size)), std::move(groups)});
    }
    return turns;
}

} // namespace vdb_shell::growth
