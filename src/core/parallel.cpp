// SPDX-License-Identifier: Apache-2.0

// Takes: what is to be done, as a pointer and a function that knows its type. Leaves it done, on
// TBB's threads, which are those of OpenVDB too. An exception ends the rest of a loop and is thrown
// on. So does the interrupter of the stage (core/stage_stop.h), which is asked between parts of a
// range: TBB makes few ranges, and one of a million indices may take seconds. Of jobs that are done
// together one that throws must not end the others: TBB would cancel the loops inside of them too,
// OpenVDB's among them, which then end without a word, and OpenVDB goes on with half of what it
// needs (seen: a crash where memory ran out in another job).

#include "core/parallel.h"

#include "core/stage_stop.h"

#include <tbb/blocked_range.h>
#include <tbb/global_control.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_invoke.h>

#include <algorithm>
#include <array>
#include <exception>

#if defined(VDB_SHELL_TELL_THREAD_SANITIZER)
#include <openvdb/openvdb.h>
#include <sanitizer/tsan_interface.h>

#include <atomic>
#include <chrono>
#include <thread>
#endif

namespace vdb_shell
{

#if defined(VDB_SHELL_TELL_THREAD_SANITIZER)
/// openvdb::initialize() locks a mutex of its own, which is not looked at, and ends with a jump to
/// the unlocking, which is taken for a call of ours. The sanitizer says that once for a mutex: so
/// it is done here first, by a name that can be left out (tests/tsan_suppressions.txt).
[[gnu::noinline]] bool initialize_openvdb_for_thread_sanitizer()
{
    openvdb::initialize();
    return true;
}
const bool openvdb_is_initialized = initialize_openvdb_for_thread_sanitizer();
#endif

std::size_t thread_count()
{
    return tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism);
}

namespace parallel
{

namespace
{

// Grains that are worked off before the interrupter is asked again. With the usual 64 that is a
// thousand indices, which take a tenth of a second in the dearest loops (moves of a vertex, 0.1
// ms).
constexpr std::size_t kGrainsBetweenAsking = 16;

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

/// Of a short loop the thread that begins it does all before another one is awake, and what one
/// thread does is no race. So under the thread sanitizer it waits for a second one, up to a
/// millisecond.
class Company
{
public:
#if defined(VDB_SHELL_TELL_THREAD_SANITIZER)
    void join()
    {
        using Clock = std::chrono::steady_clock;
        const std::thread::id self = std::this_thread::get_id();
        std::thread::id first;
        if (!first_.compare_exchange_strong(first, self)) {
            if (first != self)
                complete_ = true;
            return;
        }
        const Clock::time_point end = Clock::now() + std::chrono::milliseconds(1);
        while (!complete_ && Clock::now() < end)
            std::this_thread::yield();
    }

private:
    std::atomic<std::thread::id> first_{};
    std::atomic<bool> complete_{false};
#else
    void join() {}
#endif
};

} // namespace

void for_ranges(std::size_t count, std::size_t grain, const void* body,
                void (*call)(const void* body, std::size_t begin, std::size_t end))
{
    LatchedInterrupter* const stop = stage_stop();
    const auto call_in_parts = [=](std::size_t first, std::size_t last) {
        const StageStopScope scope(stop);
        const std::size_t part = stop ? kGrainsBetweenAsking * grain : last - first;
        for (std::size_t i = first; i < last && !(stop && stop->wasInterrupted()); i += part)
            call(body, i, std::min(last, i + part));
    };
    Milestone begin, end;
    Company company;
    begin.passed();
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count, grain),
                      [&](const tbb::blocked_range<std::size_t>& range) {
                          begin.awaited();
                          if (range.size() < count)
                              company.join();
                          call_in_parts(range.begin(), range.end());
                          end.passed();
                      });
    end.awaited();
    stop_if_stage_wants();
}

void run(const Job* jobs, std::size_t count)
{
    if (count == 1)
        jobs[0].call(jobs[0].body);
    if (count <= 1)
        return;
    LatchedInterrupter* const stop = stage_stop();
    Milestone begin, end;
    const auto marked = [&](std::exception_ptr& thrown, const auto& job) {
        const StageStopScope scope(stop);
        begin.awaited();
        try {
            job();
        } catch (...) {
            thrown = std::current_exception();
        }
        end.passed();
    };
    std::array<std::exception_ptr, 2> thrown;
    begin.passed();
    tbb::parallel_invoke([&] { marked(thrown[0], [&] { jobs[0].call(jobs[0].body); }); },
                         [&] { marked(thrown[1], [&] { run(jobs + 1, count - 1); }); });
    end.awaited();
    for (const std::exception_ptr& one : thrown)
        if (one)
            std::rethrow_exception(one);
}

} // namespace parallel

} // namespace vdb_shell
