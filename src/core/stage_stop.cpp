// SPDX-License-Identifier: Apache-2.0

// Takes and gives the interrupter of the stage that a thread works for.

#include "core/stage_stop.h"

#include "vdb_shell/core/error.h"

namespace vdb_shell
{
namespace
{

thread_local LatchedInterrupter* current = nullptr;

} // namespace

LatchedInterrupter* stage_stop()
{
    return current;
}

void stop_if_stage_wants()
{
    if (current && current->wasInterrupted())
        throw Cancelled();
}

StageStopScope::StageStopScope(LatchedInterrupter* stop) : before_(current)
{
    current = stop;
}

StageStopScope::~StageStopScope()
{
    current = before_;
}

} // namespace vdb_shell
