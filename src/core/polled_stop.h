// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/latched_interrupter.h"
#include "vdb_shell/core/error.h"

namespace vdb_shell
{

/// For a parallel loop that may take long: asks the interrupter from the thread that made this,
/// which works in the loop as the others do, and tells them. The interrupter may be null.
class PolledStop
{
public:
    explicit PolledStop(Interrupter* interrupter) : latch_(interrupter) {}

    /// Whether what is left to do is to be left out. From any thread.
    bool wanted() const { return latch_.wasInterrupted(); }
    /// After the loop, whose result is not whole then.
    void throw_if_wanted() const
    {
        if (wanted())
            throw Cancelled();
    }

private:
    mutable LatchedInterrupter latch_;
};

} // namespace vdb_shell
