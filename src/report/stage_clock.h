// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdb_shell/report/report.h"

#include "core/freed_memory.h"

#include <sys/resource.h>

#include <chrono>
#include <utility>

namespace vdb_shell
{

/// Runs stages, notes what each of them cost, and gives back what it freed.
class StageClock
{
public:
    explicit StageClock(std::vector<StageCost>& costs) : costs_(costs) {}

    template <typename Stage> void run(const std::string& name, Stage&& stage)
    {
        const auto start = std::chrono::steady_clock::now();
        std::forward<Stage>(stage)();
        const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
        costs_.push_back({name, seconds.count(), peak_memory_bytes()});
        give_back_freed_memory();
    }

private:
    static std::uint64_t peak_memory_bytes()
    {
        rusage usage{};
        ::getrusage(RUSAGE_SELF, &usage);
        constexpr std::uint64_t kBytesPerUnit = 1024; // Linux counts ru_maxrss in KiB
        return static_cast<std::uint64_t>(usage.ru_maxrss) * kBytesPerUnit;
    }
    std::vector<StageCost>& costs_;
};

} // namespace vdb_shell
