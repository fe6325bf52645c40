// SPDX-License-Identifier: Apache-2.0

// The first SIGINT or SIGTERM sets a number that the stages look at, so that they stop at a safe
// place and temporaries are removed by their owners. The second ends the process at once, for those
// who do not want to wait. A handler may only call what is async-signal-safe, so it does nothing
// else: no stream, no lock, no memory.

#include "command/signals.h"

#include "command/exit_code.h"
#include "vdb_shell/core/atomic_file.h"

#include <unistd.h>

#include <csignal>
#include <iostream>

namespace vdb_shell::command
{
namespace
{

/// The type that the C++ standard lets a handler write; the number stays 0 until a signal comes.
volatile std::sig_atomic_t signal_number = 0;

void on_signal(int number)
{
    if (signal_number != 0) {
        // _exit runs no destructor, so the temporary files have to go here.
        remove_temporaries_on_signal();
        // The status is that of a shell for a process that a signal ended: 128 and its number.
        ::_exit(signal_base + number);
    }
    signal_number = number;
}

} // namespace

void catch_signals()
{
    struct sigaction action {
    };
    action.sa_handler = on_signal;
    // No flag of sigaction is set: calls that wait return early instead of going on, and the
    // handler stays in place for the second signal.
    sigemptyset(&action.sa_mask);
    ::sigaction(SIGINT, &action, nullptr);
    ::sigaction(SIGTERM, &action, nullptr);
}

int caught_signal()
{
    return signal_number;
}

void SignalInterrupter::start(const char* name)
{
    if (show_progress_ && name)
        std::cerr << "vdb_shell: " << name << '\n';
}

bool SignalInterrupter::wasInterrupted(int)
{
    return signal_number != 0;
}

} // namespace vdb_shell::command
