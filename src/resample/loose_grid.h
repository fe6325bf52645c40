// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/box_tree.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace vdb_shell
{

/// Boxes of many sizes that come and go, and are looked up by box. Each lies in one cell, by its
/// low corner, of a lattice whose cells are no smaller than the box and no larger than twice that.
class LooseGrid
{
public:
    /// Precondition: `item` is not in the grid.
    void insert(std::uint32_t item, const FloatBox& box);
    void remove(std::uint32_t item);
    const FloatBox& box(std::uint32_t item) const { return slots_[item].box; }
    /// Fills `found` with the items whose boxes overlap this one.
    void overlaps(const FloatBox& box, std::vector<std::uint32_t>& found) const;

private:
    static constexpr std::uint32_t kNone = ~0U;
    /// Sizes are powers of two from 2^-64 to 2^63; beyond them cells are larger than they need be.
    static constexpr int kLevels = 128, kFirstPower = -64;
    using Cell = std::array<std::int64_t, 3>;
    struct Slot {
        FloatBox box{};
        Cell cell{};
        std::uint32_t next = kNone, before = kNone;
        int level = -1; ///< less than 0: not in the grid
    };

    static int level_of(const FloatBox& box);
    std::size_t bucket(int level, const Cell& cell) const;
    void link(std::uint32_t item);
    void grow();

    std::vector<Slot> slots_;         ///< by item
    std::vector<std::uint32_t> head_; ///< by bucket: the first of its items
    std::array<std::size_t, kLevels> in_level_{};
    std::size_t count_ = 0;
};

} // namespace vdb_shell
