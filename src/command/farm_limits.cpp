// SPDX-License-Identifier: Apache-2.0

// From the model of `estimate` to what a scheduler is asked for. A task that is ended for want of
// memory or time costs more than one that asked for too much, so the margins are wide.

#include "command/farm_limits.h"

#include "vdb_shell/core/error.h"

#include "command/call.h"
#include "command/cost_model.h"
#include "core/available_memory.h"

#include <algorithm>
#include <cmath>

namespace vdb_shell::command
{
namespace
{

/// Seconds of a task: starting one takes some, and what a kill costs is what it had not noted yet.
constexpr double kTaskSeconds = 600;
// Of measured calls the worst took nearly four times as long as told, and the largest memory was a
// quarter more (docs/farm.md).
constexpr double kTimeMargin = 4, kLeastMinutes = 5, kMemoryMargin = 1.25, kMoreMemoryGib = 0.25;

/// Empty where the model knows the call; else why not.
std::string add_cost(const FarmCall& call, int cpus, StepCost& dearest)
{
    // The reason is told to the user, who then knows which of --memory and --minutes to give.
    if (!is_modelled(call.command))
        return "`" + call.command + "`";
    std::error_code unknown;
    if (!std::filesystem::exists(call.first_input, unknown))
        return unknown ? "an input that cannot be read (" + call.first_input.string() + ": " +
                             unknown.message() + ")"
                       : "an input that is not there yet";
    Call first;
    first.parse(call.first_words);
    first.plan();
    try {
        const CallCost cost = estimate_call(first);
        if (!cost.not_counted.empty())
            // A number that leaves out what an option costs is too low, and a limit that is too low
            // ends the task.
            return cost.not_counted.front();
        dearest.seconds = std::max(dearest.seconds, cost.seconds(cpus));
        dearest.memory = std::max(dearest.memory, cost.memory);
        return "";
    } catch (const Error& error) {
        return error.what();
    }
}

} // namespace

/// The largest time and the largest memory, which need not be those of the same call. One call that
/// is not known leaves all tasks without a limit: they share one.
std::optional<StepCost> dearest_step(const std::vector<FarmCall>& calls, int cpus,
                                     const Context& context)
{
    StepCost dearest;
    for (const FarmCall& call : calls)
        if (const std::string unknown = add_cost(call, cpus, dearest); !unknown.empty()) {
            context.say(LogLevel::warning, "warning: no estimate of " + unknown +
                                               ": the job has no limits but those of --memory "
                                               "and --minutes");
            return std::nullopt;
        }
    return dearest;
}

std::size_t chunk_for(const StepCost& cost, std::size_t steps)
{
    // A millisecond at least, so that a model that says nothing does not divide by it.
    const double fit = kTaskSeconds / std::max(cost.seconds, 1e-3);
    return fit < double(steps) ? std::size_t(std::max(fit, 1.0)) : steps;
}

void set_limits(FarmJob& job, const StepCost& cost)
{
    constexpr double kSecondsPerMinute = 60;
    std::size_t most = 0, at_once = 1;
    for (const FarmTask& task : job.tasks) {
        std::size_t steps = 0;
        for (const FarmRun& run : task) {
            steps += std::max<std::size_t>(run.frames.size(), 1);
            // Small frames are worked on at the same time.
            at_once = std::max(at_once, std::min(run.frames.size(), std::size_t(job.limits.cpus)));
        }
        most = std::max(most, steps);
    }
    // What was given is not touched: a person knows the machines.
    // An estimate beyond what can be given is of a call that no machine can do.
    if (!job.limits.minutes)
        job.limits.minutes =
            std::clamp(kTimeMargin * double(most) * cost.seconds / kSecondsPerMinute, kLeastMinutes,
                       FarmLimits::kMostMinutes);
    if (!job.limits.memory_gib)
        job.limits.memory_gib =
            std::min(kMemoryMargin * double(at_once) * cost.memory / kBytesPerGib + kMoreMemoryGib,
                     FarmLimits::kMostMemoryGib);
}

} // namespace vdb_shell::command
