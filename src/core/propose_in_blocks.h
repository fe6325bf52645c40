// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/parallel.h"

#include <algorithm>
#include <cstddef>

namespace vdb_shell
{

/// Changes that have an order and may touch each other, with most of their work on all threads.
/// Items come in blocks: begin() once, then propose(item, slot) for each on any thread, with the
/// state as it is, then make(item, slot) for each in order on this one. What an earlier item of the
/// block has changed, make() has to see for itself. Slots run from 0 to block - 1.
template <class Begin, class Propose, class Make>
void propose_in_blocks(std::size_t count, std::size_t block, const Begin& begin,
                       const Propose& propose, const Make& make)
{
    constexpr std::size_t kAtOnce = 4; // a proposal takes some microseconds at least
    for (std::size_t first = 0; first < count; first += block) {
        const std::size_t size = std::min(block, count - first);
        begin();
        for_each_index(
            size, [&](std::size_t slot) { propose(first + slot, slot); }, kAtOnce);
        for (std::size_t slot = 0; slot < size; ++slot)
            make(first + slot, slot);
    }
}

} // namespace vdb_shell
