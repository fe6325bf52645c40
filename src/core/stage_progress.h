// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdb_shell/core/error.h"
#include "vdb_shell/core/interrupter.h"

namespace vdb_shell
{

/// Frames a stage for the interrupter, which may be null.
class StageProgress
{
public:
    StageProgress(Interrupter* interrupter, const char* name) : interrupter_(interrupter)
    {
        if (interrupter_)
            interrupter_->start(name);
        stop_if_interrupted(0);
    }
    ~StageProgress()
    {
        if (interrupter_)
            interrupter_->end();
    }
    StageProgress(const StageProgress&) = delete;
    StageProgress& operator=(const StageProgress&) = delete;

    /// Throws Cancelled when the caller wants to stop. Call it from the stage's own thread only.
    void stop_if_interrupted(int percent) const
    {
        if (interrupter_ && interrupter_->wasInterrupted(percent))
            throw Cancelled();
    }

    /// For what asks it on its own (core/polled_stop.h); may be null.
    Interrupter* interrupter() const { return interrupter_; }

private:
    Interrupter* interrupter_;
};

} // namespace vdb_shell
