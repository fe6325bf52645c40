// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/stage_stop.h"
#include "vdb_shell/core/error.h"
#include "vdb_shell/core/interrupter.h"

#include <algorithm>
#include <optional>

namespace vdb_shell
{

/// Frames a stage for the interrupter, which may be null. As long as it lives, the loops of
/// core/parallel.h ask the interrupter too, in the middle of their ranges, and throw Cancelled.
class StageProgress
{
public:
    StageProgress(Interrupter* interrupter, const char* name) : interrupter_(interrupter)
    {
        if (interrupter_)
            interrupter_->start(name);
        // Told to stop at once, the frame is closed by hand, for there is no destructor yet.
        try {
            stop_if_interrupted(0);
        } catch (const Cancelled&) {
            interrupter_->end();
            throw;
        }
        if (interrupter_) {
            asked_by_loops_.emplace(interrupter_);
            scope_.emplace(&*asked_by_loops_);
        }
    }
    ~StageProgress()
    {
        if (interrupter_ && !is_part_)
            interrupter_->end();
    }
    StageProgress(const StageProgress&) = delete;
    StageProgress& operator=(const StageProgress&) = delete;

    /// What a piece of the stage's work is told, so that its 0 to 100 percent are `from` to `to` of
    /// the stage. Must not outlive the stage.
    StageProgress part(double from, double to) const
    {
        const double span = to_ - from_;
        return StageProgress(interrupter_, from_ + span * from / 100, from_ + span * to / 100);
    }

    /// Throws Cancelled when the caller wants to stop. Call it from the stage's own thread only.
    void stop_if_interrupted(double percent) const
    {
        const double of_stage = from_ + (to_ - from_) * std::clamp(percent, 0.0, 100.0) / 100;
        if (interrupter_ && interrupter_->wasInterrupted(static_cast<int>(of_stage)))
            throw Cancelled();
    }

private:
    StageProgress(Interrupter* interrupter, double from, double to)
        : interrupter_(interrupter), from_(from), to_(to), is_part_(true)
    {
    }

    Interrupter* interrupter_;
    double from_ = 0, to_ = 100; ///< percent of the stage
    bool is_part_ = false;
    std::optional<LatchedInterrupter> asked_by_loops_;
    std::optional<StageStopScope> scope_;
};

} // namespace vdb_shell
