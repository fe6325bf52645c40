// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdb_shell/core/interrupter.h"

#include "command/context.h"

#include <thread>

namespace vdb_shell::command
{

/// From now on SIGHUP, SIGINT, SIGTERM, SIGXCPU and SIGPIPE end the process at once, without
/// leaving temporary files behind; SIGXFSZ is a write that fails.
void catch_signals();

/// What is thrown where nobody can catch it ends the process too without leaving temporary files
/// behind: out_of_memory for lack of memory, an abort for all else.
void end_uncaught_exceptions();

/// Standard streams that are closed are opened on nothing, so that no output file gets their number
/// and with it what is printed.
void occupy_standard_streams();

/// The signal that came, or 0.
int caught_signal();

/// While one lives the first signal asks the stages to stop, and only the second ends the process:
/// for the time when an outside program may run.
class PoliteStop
{
public:
    explicit PoliteStop(bool wanted);
    ~PoliteStop();
    PoliteStop(const PoliteStop&) = delete;
    PoliteStop& operator=(const PoliteStop&) = delete;

private:
    bool wanted_;
};

/// Tells stages to stop once a signal has come, and shows which stage runs where that is wanted.
class SignalInterrupter final : public Interrupter
{
public:
    explicit SignalInterrupter(const Context& context) : context_(context) {}
    void start(const char* name) override;
    void end() override {}
    bool wasInterrupted(int percent = -1) override;

private:
    const Context& context_;
    const std::thread::id owner_ = std::this_thread::get_id();
};

} // namespace vdb_shell::command
