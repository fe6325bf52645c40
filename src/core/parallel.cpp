// SPDX-License-Identifier: Apache-2.0

// Takes: what is to be done, as a pointer and a function that knows its type. Leaves it done, on
// TBB's threads, which are those of OpenVDB too. An exception ends the rest and is thrown on.

#include "core/parallel.h"

#include <tbb/blocked_range.h>
#include <tbb/global_control.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_invoke.h>

#if defined(VDB_SHELL_TELL_THREAD_SANITIZER)
#include <sanitizer/tsan_interface.h>
#endif

namespace vdb_shell
{

std::size_t thread_count()
{
    return tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism);
}

namespace parallel
{

namespace
{

/// What is written before passed() can be read after awaited(). TBB sees to that; this tells the
/// thread sanitizer, which does not see into a TBB that was not compiled with it.
class Milestone
{
public:
#if defined(VDB_SHELL_TELL_THREAD_SANITIZER)
    void passed()
    {
        __tsan_release(this);
    }
    void awaited()
    {
        __tsan_acquire(this);
    }

private:
    char place_ = 0;
#else
    void passed() {}
    void awaited() {}
#endif
};

} // namespace

void for_ranges(std::size_t count, std::size_t grain, const void* body,
                void (*call)(const void* body, std::size_t begin, std::size_t end))
{
    Milestone begin, end;
    begin.passed();
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count, grain),
                      [=, &begin, &end](const tbb::blocked_range<std::size_t>& range) {
                          begin.awaited();
                          call(body, range.begin(), range.end());
                          end.passed();
                      });
    end.awaited();
}

void run(const Job* jobs, std::size_t count)
{
    if (count == 1)
        jobs[0].call(jobs[0].body);
    if (count <= 1)
        return;
    Milestone begin, end;
    const auto marked = [&](const auto& job) {
        begin.awaited();
        job();
        end.passed();
    };
    begin.passed();
    tbb::parallel_invoke([&] { marked([&] { jobs[0].call(jobs[0].body); }); },
                         [&] { marked([&] { run(jobs + 1, count - 1); }); });
    end.awaited();
}

} // namespace parallel

} // namespace vdb_shell
