// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdb_shell/report/report.h"

#include "core/freed_memory.h"
#include "core/stage_stop.h"

#include <sys/resource.h>

#include <chrono>
#include <utility>

namespace vdb_shell
{

/// Runs stages, notes what each of them cost, and gives back what it freed. What a stage does
/// between calls that take the interrupter asks it too. It may be null.
class StageClock
{
public:
    StageClock(std::vector<StageCost>& costs, Interrupter* interrupter)
        : costs_(costs), interrupter_(interrupter)
    {
    }

    template <typename Stage> void run(const std::string& name, Stage&& stage)
    {
        const auto start = std::chrono::steady_clock::now();
        {
            LatchedInterrupter asked_by_loops(interrupter_);
            const StageStopScope scope(interrupter_ ? &asked_by_loops : stage_stop());
            std::forward<Stage>(stage)();
        }
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
    Interrupter* interrupter_;
};

} // namespace vdb_shell
