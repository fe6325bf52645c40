// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "command/farm_job.h"

#include <optional>

namespace vdb_shell::command
{

/// What the dearest step of a job costs: a frame, or a call without frames.
struct StepCost {
    double seconds = 0; ///< on the processors of a task
    double memory = 0;  ///< bytes
};

/// By the model of `estimate`, from the first frame of each call; reads its surface. Nothing where
/// the model does not know a call, which is said.
std::optional<StepCost> dearest_step(const std::vector<FarmCall>& calls, int cpus,
                                     const Context& context);

/// Steps that take ten minutes, of `steps` in all.
std::size_t chunk_for(const StepCost& cost, std::size_t steps);

/// Memory and time of a task, with margins, where they were not given. After the tasks are made.
void set_limits(FarmJob& job, const StepCost& cost);

} // namespace vdb_shell::command
