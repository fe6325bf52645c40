// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/latched_interrupter.h"

#include <cstddef>

namespace vdb_shell
{

/// Whom the loops of this thread ask whether to go on: the interrupter of the stage that they are
/// part of, or null. A stage sets it (StageProgress), and loops hand it on to the threads that work
/// for them, so that no loop in between has to know of it.
LatchedInterrupter* stage_stop();

/// Throws Cancelled where the stage is to stop: for long work between loops, as sorting. From any
/// thread that works for the stage.
void stop_if_stage_wants();
/// The same once in a thousand indices, for loops of one thread whose steps are short.
inline void stop_if_stage_wants(std::size_t index)
{
    if (index % 1024 == 0)
        stop_if_stage_wants();
}

/// Sets it for as long as this lives.
class StageStopScope
{
public:
    explicit StageStopScope(LatchedInterrupter* stop);
    ~StageStopScope();
    StageStopScope(const StageStopScope&) = delete;
    StageStopScope& operator=(const StageStopScope&) = delete;

private:
    LatchedInterrupter* before_;
};

} // namespace vdb_shell
