// SPDX-License-Identifier: Apache-2.0
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

volatile std::sig_atomic_t signal_number = 0;

void on_signal(int number)
{
    if (signal_number != 0) {
        remove_temporaries_on_signal();
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
