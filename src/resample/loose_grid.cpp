// SPDX-License-Identifier: Apache-2.0

// Takes boxes, one at a time, and finds those that overlap a box. The trees of core/ are built for
// all boxes at once; here each operation on a surface changes a few of them. A box has one entry,
// so a change costs little, and a query looks at the cells from one cell below its own low corner
// to its high corner, in each of the few sizes that are in use.

#include "resample/loose_grid.h"

#include <algorithm>
#include <cmath>

namespace vdb_shell
{
namespace
{

constexpr std::size_t kFewestBuckets = 1024;

std::array<std::int64_t, 3> cell_at(const FourFloats& p, double cell_size)
{
    std::array<std::int64_t, 3> cell{};
    for (std::size_t k = 0; k < 3; ++k)
        // Far beyond what boxes of that size can be told apart by, and far from overflow.
        cell[k] = static_cast<std::int64_t>(
            std::clamp(std::floor(double(p[k]) / cell_size), -1e15, 1e15));
    return cell;
}

} // namespace

int LooseGrid::level_of(const FloatBox& box)
{
    const FourFloats size = box.hi - box.lo;
    const double most = std::max({double(size[0]), double(size[1]), double(size[2])});
    const int power = most > 0 ? std::ilogb(most) + 1 : kFirstPower;
    return std::clamp(power - kFirstPower, 0, kLevels - 1);
}

std::size_t LooseGrid::bucket(int level, const Cell& cell) const
{
    // Odd multipliers near powers of two times the golden ratio spread neighbours over the buckets.
    std::uint64_t hash = std::uint64_t(level) * 0x9E3779B97F4A7C15U;
    hash = (hash ^ std::uint64_t(cell[0])) * 0xBF58476D1CE4E5B9U;
    hash = (hash ^ std::uint64_t(cell[1])) * 0x94D049BB133111EBU;
    hash = (hash ^ std::uint64_t(cell[2])) * 0x9E3779B97F4A7C15U;
    return std::size_t(hash >> 20U) & (head_.size() - 1);
}

void LooseGrid::link(std::uint32_t item)
{
    Slot& slot = slots_[item];
    std::uint32_t& head = head_[bucket(slot.level, slot.cell)];
    slot.before = kNone;
    slot.next = head;
    if (head != kNone)
        slots_[head].before = item;
    head = item;
}

void LooseGrid::grow()
{
    head_.assign(std::max(kFewestBuckets, 2 * head_.size()), kNone);
    for (std::uint32_t item = 0; item < slots_.size(); ++item)
        if (slots_[item].level >= 0)
            link(item);
}

void LooseGrid::insert(std::uint32_t item, const FloatBox& box)
{
    if (count_ >= head_.size())
        grow();
    if (item >= slots_.size())
        slots_.resize(std::max<std::size_t>(item + 1, slots_.size() * 3 / 2));
    Slot& slot = slots_[item];
    slot.box = box;
    slot.level = level_of(box);
    slot.cell = cell_at(box.lo, std::ldexp(1.0, slot.level + kFirstPower));
    link(item);
    ++in_level_[std::size_t(slot.level)];
    ++count_;
}

void LooseGrid::remove(std::uint32_t item)
{
    Slot& slot = slots_[item];
    if (slot.before != kNone)
        slots_[slot.before].next = slot.next;
    else
        head_[bucket(slot.level, slot.cell)] = slot.next;
    if (slot.next != kNone)
        slots_[slot.next].before = slot.before;
    --in_level_[std::size_t(slot.level)];
    --count_;
    slot.level = -1;
}

void LooseGrid::overlaps(const FloatBox& box, std::vector<std::uint32_t>& found) const
{
    found.clear();
    for (int level = 0; level < kLevels; ++level) {
        if (in_level_[std::size_t(level)] == 0)
            continue;
        const double size = std::ldexp(1.0, level + kFirstPower);
        Cell low = cell_at(box.lo, size);
        const Cell high = cell_at(box.hi, size);
        double cells = 1;
        for (std::size_t k = 0; k < 3; ++k) {
            --low[k];
            cells *= double(high[k] - low[k] + 1);
        }
        // A box that is large beside those of this size: all of them are fewer than its cells.
        if (cells > double(slots_.size())) {
            for (std::uint32_t item = 0; item < slots_.size(); ++item)
                if (slots_[item].level == level && slots_[item].box.overlaps(box))
                    found.push_back(item);
            continue;
        }
        Cell cell{};
        for (cell[0] = low[0]; cell[0] <= high[0]; ++cell[0])
            for (cell[1] = low[1]; cell[1] <= high[1]; ++cell[1])
                for (cell[2] = low[2]; cell[2] <= high[2]; ++cell[2])
                    for (std::uint32_t item = head_[bucket(level, cell)]; item != kNone;
                         item = slots_[item].next) {
                        const Slot& slot = slots_[item];
                        if (slot.level == level && slot.cell == cell && slot.box.overlaps(box))
                            found.push_back(item);
                    }
    }
}

} // namespace vdb_shell
