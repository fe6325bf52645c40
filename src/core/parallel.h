// SPDX-License-Identifier: Apache-2.0
#pragma once

// The one place, besides OpenVDB's own tools, where threads are made. Every index writes its own
// slot, so results do not depend on the number of threads; sums are made afterwards, in index
// order. What is to be done goes to core/parallel.cpp as a pointer, for each loop that TBB's
// templates see costs a source a third of a second (GCC 12), and a call per range costs nothing
// beside the range.

#include <algorithm>
#include <cstddef>
#include <memory>
#include <vector>

namespace vdb_shell
{

namespace parallel
{

/// Calls call(body, begin, end) for disjoint ranges of [0, count).
void for_ranges(std::size_t count, std::size_t grain, const void* body,
                void (*call)(const void* body, std::size_t begin, std::size_t end));

struct Job {
    const void* body;
    void (*call)(const void* body);
};
void run(const Job* jobs, std::size_t count);

template <typename Body> Job job(const Body& body)
{
    return {std::addressof(body), [](const void* b) { (*static_cast<const Body*>(b))(); }};
}

} // namespace parallel

/// How many threads loops may use here.
std::size_t thread_count();

/// body(begin, end) over disjoint ranges of [0, count): for bodies that need an accessor per range.
template <typename Body>
void for_each_range(std::size_t count, const Body& body, std::size_t grain = 64)
{
    parallel::for_ranges(count, grain, std::addressof(body),
                         [](const void* b, std::size_t begin, std::size_t end) {
                             (*static_cast<const Body*>(b))(begin, end);
                         });
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

/// The sum of term(index) over [0, count): terms are found on all threads and added on this one, in
/// the order of their indices, so that it is rounded the same way each time.
template <typename Term> double sum_in_order(std::size_t count, const Term& term)
{
    constexpr std::size_t kBlock = 1 << 15; // terms that stay in the cache
    std::vector<double> terms(std::min(count, kBlock));
    double sum = 0;
    for (std::size_t first = 0; first < count; first += kBlock) {
        const std::size_t size = std::min(kBlock, count - first);
        for_each_index(
            size, [&](std::size_t i) { terms[i] = term(first + i); }, 1024);
        for (std::size_t i = 0; i < size; ++i)
            sum += terms[i];
    }
    return sum;
}

/// Calls them all, in any order or at once: for jobs that are serial in part and write what none of
/// the others reads. Where some throw, the others are done all the same; then what the first of
/// those in the list threw is thrown on.
template <typename... Body> void run_together(const Body&... body)
{
    const parallel::Job jobs[] = {parallel::job(body)...};
    parallel::run(jobs, sizeof...(body));
}

} // namespace vdb_shell
