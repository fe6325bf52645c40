// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdb_shell/core/interrupter.h"

namespace vdb_shell::command
{

/// From now on SIGINT and SIGTERM ask the stages to stop; a second one ends the process at once,
/// without leaving temporary files behind.
void catch_signals();

/// The signal that came, or 0.
int caught_signal();

/// Tells stages to stop once a signal has come, and shows which stage runs on standard error when
/// wanted.
class SignalInterrupter final : public Interrupter
{
public:
    explicit SignalInterrupter(bool show_progress) : show_progress_(show_progress) {}
    void start(const char* name) override;
    void end() override {}
    bool wasInterrupted(int percent = -1) override;

private:
    bool show_progress_;
};

} // namespace vdb_shell::command
