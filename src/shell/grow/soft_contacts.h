// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "shell/grow/grow_state.h"

namespace vdb_shell::growth
{

/// A list of small numbers without repeats, in the order they came.
class UniqueList
{
public:
    void clear(std::size_t numbers)
    {
        items_.clear();
        seen_.resize(numbers, 0);
        ++tick_;
    }
    void add(int number)
    {
        if (seen_[number] == tick_)
            return;
        seen_[number] = tick_;
        items_.push_back(number);
    }
    std::vector<int>::const_iterator begin() const { return items_.begin(); }
    std::vector<int>::const_iterator end() const { return items_.end(); }

private:
    std::vector<int> items_;
    std::vector<std::uint32_t> seen_; ///< the tick at which a number was last added
    std::uint32_t tick_ = 0;
};

/// Scratch of one thread.
struct ContactScratch {
    UniqueList near;   ///< triangles: inner f, outer F + f
    UniqueList corner; ///< their corners: outer v, inner V + v
};

/// Appends soft bounds on b_v from triangles and corners closer than a share of v's reach. They
/// only steer a move away before it touches; the exact test decides.
void contact_bounds(const GrowState& s, int v, ContactScratch& scratch,
                    std::vector<HalfSpace>& bounds);

} // namespace vdb_shell::growth
