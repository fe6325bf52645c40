// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdb_shell/core/interrupter.h"

#include <atomic>
#include <thread>

namespace vdb_shell
{

/// Hands a caller's interrupter (may be null) to OpenVDB's tools and remembers that it was used:
/// the tools return what they have so far when they are stopped, and do not say that they were.
class LatchedInterrupter final : public Interrupter
{
public:
    explicit LatchedInterrupter(Interrupter* caller) : caller_(caller) {}

    // Tools poll from their worker threads, where a caller's interface must not be called; and the
    // stage, not the tool, frames itself with start and end.
    bool wasInterrupted(int percent = -1) override
    {
        if (caller_ && std::this_thread::get_id() == owner_ && caller_->wasInterrupted(percent))
            stopped_ = true;
        return stopped_;
    }
    bool stopped() const { return stopped_; }

private:
    Interrupter* caller_;
    std::thread::id owner_ = std::this_thread::get_id();
    std::atomic<bool> stopped_{false};
};

} // namespace vdb_shell
