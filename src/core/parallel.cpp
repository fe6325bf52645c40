// SPDX-License-Identifier: Apache-2.0

// Takes: what is to be done, as a pointer and a function that knows its type. Leaves it done, on
// TBB's threads, which are those of OpenVDB too. An exception ends the rest and is thrown on.

#include "core/parallel.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_invoke.h>

namespace vdb_shell::parallel
{

void for_ranges(std::size_t count, std::size_t grain, const void* body,
                void (*call)(const void* body, std::size_t begin, std::size_t end))
{
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count, grain),
                      [=](const tbb::blocked_range<std::size_t>& range) {
                          call(body, range.begin(), range.end());
                      });
}

void run(const Job* jobs, std::size_t count)
{
    if (count == 1)
        jobs[0].call(jobs[0].body);
    if (count > 1)
        tbb::parallel_invoke([=] { jobs[0].call(jobs[0].body); },
                             [=] { run(jobs + 1, count - 1); });
}

} // namespace vdb_shell::parallel
