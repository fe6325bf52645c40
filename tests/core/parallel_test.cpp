// SPDX-License-Identifier: Apache-2.0

// What loops of several threads leave is what loops of one would, to the last bit.

#include "core/parallel.h"
#include "core/parallel_sort.h"

#include <gtest/gtest.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <functional>
#include <new>
#include <stdexcept>
#include <thread>
#include <vector>

namespace vdb_shell
{
namespace
{

/// Of sizes that differ by many powers of ten, so that another order of adding them shows.
std::vector<double> terms(std::size_t count)
{
    std::vector<double> all;
    for (std::size_t i = 0; i < count; ++i)
        all.push_back(std::ldexp(1.0 + double(i % 17), int(i * 7919 % 60)) * (i % 3 == 0 ? -1 : 1));
    return all;
}

TEST(Parallel, SumIsThatOfOneThread)
{
    for (const std::size_t count : {0, 1, 1000, 32768, 32769, 200000}) {
        const std::vector<double> all = terms(count);
        double expected = 0;
        for (const double term : all)
            expected += term;
        EXPECT_EQ(sum_in_order(count, [&](std::size_t i) { return all[i]; }), expected) << count;
    }
}

TEST(Parallel, SortsLikeOneThread)
{
    std::vector<std::uint64_t> numbers;
    for (std::uint64_t i = 0; i < 100000; ++i)
        numbers.push_back(i * 0x9E3779B97F4A7C15U);
    std::vector<std::uint64_t> expected = numbers;
    std::sort(expected.begin(), expected.end());
    parallel_sort(numbers.begin(), numbers.end(), std::less<>());
    EXPECT_EQ(numbers, expected);
}

// A loop of TBB's inside of a job stands for those of OpenVDB's tools, which go on with whatever a
// cancelled loop has left.
TEST(RunTogether, DoesTheOthersToTheirEndsWhereOneThrows)
{
    constexpr std::size_t kCount = 10000;
    for (const bool throws_first : {true, false}) {
        std::atomic<bool> thrown{false};
        std::atomic<std::size_t> done{0};
        const auto throws = [&] {
            thrown = true;
            throw std::bad_alloc();
        };
        const auto counts = [&] {
            using Clock = std::chrono::steady_clock;
            // One thread may do this job first, so it does not wait for ever.
            for (const auto end = Clock::now() + std::chrono::milliseconds(200);
                 !thrown && Clock::now() < end;)
                std::this_thread::yield();
            std::this_thread::sleep_for(std::chrono::milliseconds(20));
            tbb::parallel_for(std::size_t(0), kCount, [&](std::size_t) { ++done; });
        };
        if (throws_first)
            EXPECT_THROW(run_together(throws, counts), std::bad_alloc);
        else
            EXPECT_THROW(run_together(counts, counts, throws), std::bad_alloc);
        EXPECT_EQ(done, throws_first ? kCount : 2 * kCount);
    }
}

TEST(RunTogether, ThrowsWhatTheFirstInTheListThrew)
{
    for (int i = 0; i < 100; ++i)
        EXPECT_THROW(run_together([] {}, [] { throw std::bad_alloc(); },
                                  [] { throw std::runtime_error("later in the list"); }),
                     std::bad_alloc);
}

} // namespace
} // namespace vdb_shell
