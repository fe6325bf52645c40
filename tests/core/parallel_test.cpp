// SPDX-License-Identifier: Apache-2.0

// What loops of several threads leave is what loops of one would, to the last bit.

#include "core/parallel.h"
#include "core/parallel_sort.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
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

} // namespace
} // namespace vdb_shell
