// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdb_shell/core/error.h"
#include "vdb_shell/core/interrupter.h"

#include <gtest/gtest.h>

namespace vdb_shell::test
{

/// Ends a stage at its first question.
struct StopAtOnce : Interrupter {
    void start(const char*) override {}
    void end() override {}
    bool wasInterrupted(int) override { return true; }
};

/// call(interrupter) ends when the interrupter wants it.
template <typename Call> void expect_cancelled(const Call& call)
{
    StopAtOnce interrupter;
    EXPECT_THROW(call(&interrupter), Cancelled);
}

} // namespace vdb_shell::test
