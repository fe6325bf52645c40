// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/parallel.h"
#include "core/stage_stop.h"

#include <algorithm>

namespace vdb_shell
{

/// Sorts on all threads. Precondition: `before` tells any two elements apart, or else their order
/// would be that of the library's algorithm. Not TBB's sort, whose threads the thread sanitizer
/// cannot follow (core/parallel.h).
template <class Iterator, class Before>
void parallel_sort(Iterator begin, Iterator end, const Before& before)
{
    // Below this many elements a second thread costs more than it saves.
    constexpr auto kParallel = 4096;
    if (end - begin < kParallel) {
        std::sort(begin, end, before);
        return;
    }
    stop_if_stage_wants();
    const Iterator middle = begin + (end - begin) / 2;
    std::nth_element(begin, middle, end, before);
    run_together([&] { parallel_sort(begin, middle, before); },
                 [&] { parallel_sort(middle, end, before); });
}

} // namespace vdb_shell
