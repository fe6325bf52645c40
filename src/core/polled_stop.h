// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdb_shell/core/error.h"
#include "vdb_shell/core/interrupter.h"

#include <atomic>
#include <thread>

namespace vdb_shell
{

/// For a parallel loop that may take long: asks the interrupter from the thread that made this,
/// which works in the loop as the others do, and tells them. The interrupter may be null.
class PolledStop
{
public:
    explicit PolledStop(Interrupter* interrupter)
        : interrupter_(interrupter), owner_(std::this_thread::get_id())
    {
    }

    /// Whether what is left to do is to be left out. From any thread.
    bool wanted() const
    {
        if (interrupter_ && !wanted_ && std::this_thread::get_id() == owner_ &&
            interrupter_->wasInterrupted())
            wanted_ = true;
        return wanted_;
    }
    /// After the loop, whose result is not whole then.
    void throw_if_wanted() const
    {
        if (wanted())
            throw Cancelled();
    }

private:
    Interrupter* interrupter_;
    std::thread::id owner_;
    mutable std::atomic<bool> wanted_{false};
};

} // namespace vdb_shell
