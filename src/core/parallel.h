// SPDX-License-Identifier: Apache-2.0
#pragma once

// The one place, besides OpenVDB's own tools, where threads are made. Every index writes its own
// slot, so results do not depend on the number of threads; sums are made afterwards, in index
// order.

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_invoke.h>

#include <cstddef>

namespace vdb_shell
{

/// body(begin, end) over disjoint ranges of [0, count): for bodies that need an accessor per range.
template <typename Body>
void for_each_range(std::size_t count, const Body& body, std::size_t grain = 64)
{
    tbb::parallel_for(
        tbb::blocked_range<std::size_t>(0, count, grain),
        [&](const tbb::blocked_range<std::size_t>& range) { body(range.begin(), range.end()); });
}

/// body(index) for each index of [0, count).
template <typename Body>
void for_each_index(std::size_t count, const Body& body, std::size_t grain = 64)
{
    for_each_range(
        count,
        [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i)
                body(i);
        },
        grain);
}

/// Calls them all, in any order or at once: for jobs that are serial in part and write what none of
/// the others reads.
template <typename... Job> void run_together(const Job&... job)
{
    tbb::parallel_invoke(job...);
}

} // namespace vdb_shell
