// SPDX-License-Identifier: Apache-2.0

// A signal ends the process at once, whatever it does: all files under way are temporaries, whose
// names a table holds for the handler. There are two exceptions. While files are put in their
// places, which takes milliseconds, the signal waits. While an outside program may run, the first
// signal sets a number that the stages look at, so that they end the program and remove its folder;
// the second ends the process at once. A handler may only call what is async-signal-safe: no
// stream, no lock, no memory.

#include "command/signals.h"

#include "command/exit_code.h"
#include "command/progress.h"
#include "vdb_shell/core/atomic_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <iostream>
#include <new>

namespace vdb_shell::command
{
namespace
{

/// 0 until a signal comes. Handlers may write atomics without locks, and other threads read them.
std::atomic<int> signal_number{0};
std::atomic<int> polite_stops{0};
static_assert(std::atomic<int>::is_always_lock_free);

const char* stopped_by(int number)
{
    switch (number) {
    case SIGHUP:
        return "vdb_shell: stopped by SIGHUP\n";
    case SIGINT:
        return "vdb_shell: stopped by SIGINT\n";
    case SIGTERM:
        return "vdb_shell: stopped by SIGTERM\n";
    case SIGXCPU:
        return "vdb_shell: stopped by SIGXCPU: the limit on processor time is reached\n";
    default: // SIGPIPE: who reads no further knows it
        return "";
    }
}

void say(const char* text)
{
    if (::write(STDERR_FILENO, text, std::strlen(text)) < 0)
        errno = 0; // there is nobody left to tell
}

void on_signal(int number)
{
    // The second signal of a person who waits ends the process, whatever an outside program leaves
    // behind.
    const bool first = signal_number.exchange(number) == 0;
    // From here on no other thread begins to put files in their places: its temporaries would be
    // removed in the middle of that.
    if ((first && polite_stops > 0) || !hold_commits())
        return;
    // _exit runs no destructor, so the temporary files have to go here.
    remove_temporaries_on_signal();
    // After the files are gone, so that who reads the line may start again.
    say(stopped_by(number));
    // The status is that of a shell for a process that a signal ended: 128 and its number.
    ::_exit(signal_base + number);
}

/// The system call that met the limit returns an error all the same.
void on_ignored_signal(int) {}

void on_terminate()
{
    remove_temporaries_on_signal();
    try {
        if (const std::exception_ptr thrown = std::current_exception())
            std::rethrow_exception(thrown);
    } catch (const std::bad_alloc&) {
        say("vdb_shell: out of memory\n");
        ::_exit(out_of_memory);
    } catch (const std::exception& error) {
        std::cerr << "vdb_shell: " << error.what() << '\n';
    }
    // An exception that nobody can catch is a fault of ours: a core file says where it came from.
    std::abort();
}

/// What was ignored when the program was started (nohup, a shell's background) stays ignored.
void handle(int number, void (*handler)(int))
{
    struct sigaction action {
    };
    if (::sigaction(number, nullptr, &action) != 0 || action.sa_handler == SIG_IGN)
        return;
    action = {};
    action.sa_handler = handler;
    // No flag of sigaction is set: calls that wait return early instead of going on, and the
    // handler stays in place for the second signal.
    sigemptyset(&action.sa_mask);
    ::sigaction(number, &action, nullptr);
}

} // namespace

void catch_signals()
{
    for (const int number : {SIGHUP, SIGINT, SIGTERM, SIGXCPU, SIGPIPE})
        handle(number, on_signal);
    // Nothing happens but that the write fails, which is told as any failure. A handler and not
    // SIG_IGN, which outside programs would inherit.
    handle(SIGXFSZ, on_ignored_signal);
}

void end_uncaught_exceptions()
{
    std::set_terminate(on_terminate);
}

void occupy_standard_streams()
{
    for (int stream = STDIN_FILENO; stream <= STDERR_FILENO; ++stream)
        if (::fcntl(stream, F_GETFD) < 0)
            // The lowest free number, which is this one. It cannot be written, so that text which
            // nobody gets is an error as it was.
            ::open("/dev/null", O_RDONLY);
}

int caught_signal()
{
    return signal_number;
}

PoliteStop::PoliteStop(bool wanted) : wanted_(wanted)
{
    polite_stops += wanted_ ? 1 : 0;
}

PoliteStop::~PoliteStop()
{
    polite_stops -= wanted_ ? 1 : 0;
}

void SignalInterrupter::start(const char* name)
{
    if (context_.progress && name)
        context_.progress->stage(name);
}

bool SignalInterrupter::wasInterrupted(int percent)
{
    // Tools of OpenVDB ask from any of their threads.
    if (context_.progress && std::this_thread::get_id() == owner_)
        context_.progress->percent_of_stage(percent);
    return signal_number != 0;
}

} // namespace vdb_shell::command
