#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""What a signal does to a command that works: signals.py COMMAND MESH

A build that takes long gets each signal after its first line of progress. It has to end with 128 and
the signal's number, to say why in one line (nothing for SIGPIPE), and to leave the old output and
nothing else (docs/reliability.md, "Signals"). The same for the two signals that the system sends by
itself, and for one that was ignored when the command was started. faults.py has signals at random
moments.
Prints what is not so and ends with status 1.
"""
import json
import os
import pathlib
import resource
import signal
import subprocess
import sys
import tempfile

from faults import require, status_of

# The page's table, not what the machine calls them.
STATUS = {signal.SIGHUP: 129, signal.SIGINT: 130, signal.SIGPIPE: 141, signal.SIGTERM: 143, signal.SIGXCPU: 152}
OLD = b"what stood here before"


def is_progress(line):
    try:
        return "stage" in json.loads(line)
    except ValueError:
        return False


def at_start(ignored=(), seconds=None):
    """What the command inherits. Who runs this test may ignore some signals, as nohup does."""
    for number in STATUS:
        signal.signal(number, signal.SIG_IGN if number in ignored else signal.SIG_DFL)
    if seconds:
        resource.setrlimit(resource.RLIMIT_CPU, (seconds, resource.RLIM_INFINITY))


def stopped(line, folder, name, send, wanted, said, **start):
    """send(process) after the first line of progress."""
    output = folder / "old.vtu"
    output.write_bytes(OLD)
    process = subprocess.Popen([*line, "-o", output], stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                               preexec_fn=lambda: at_start(**start))
    first = process.stderr.readline()
    require(is_progress(first), f"{name}: begins with {first!r}")
    send(process)
    out, rest = process.communicate()
    status = process.returncode
    messages = [text for text in rest.decode().splitlines(keepends=True) if not is_progress(text)]
    at = f"{name}: status {status}, {messages}"
    require(status != 0, f"{at}: the build was done before the signal came")
    require(status == wanted, f"{at}, must be {wanted}")
    require(messages == said, f"{at}, must say {said}")
    require(not out, f"{at}: {out!r} on standard output")
    left = sorted(path.name for path in folder.iterdir())
    require(left == [output.name] and output.read_bytes() == OLD, f"{at}: {left}")
    print(f"{name}: {status}", flush=True)


def unread_pipe(command):
    """Nobody reads what is printed."""
    reader, writer = os.pipe()
    os.close(reader)
    done = subprocess.run([command, "options", "--json"], stdout=writer, stderr=subprocess.PIPE,
                          preexec_fn=at_start)
    os.close(writer)
    require(done.returncode == STATUS[signal.SIGPIPE] and not done.stderr,
            f"a pipe that nobody reads: status {done.returncode}, {done.stderr!r}")
    print(f"a pipe that nobody reads: {done.returncode}")


def main():
    command, mesh = sys.argv[1:]
    # 540,000 triangles: many seconds before there is a shell, so that no signal comes too late.
    line = [command, "--progress", "json", "build", mesh, "--subdivide", "3", "--samples", "0", "-q"]
    with tempfile.TemporaryDirectory() as work:
        folder = pathlib.Path(work)
        for number, status in STATUS.items():
            reason = ": the limit on processor time is reached" if number == signal.SIGXCPU else ""
            said = [] if number == signal.SIGPIPE else [f"vdb_shell: stopped by {number.name}{reason}\n"]
            stopped(line, folder, number.name, lambda process, n=number: process.send_signal(n), status, said)

        def hang_up_and_end(process):
            process.send_signal(signal.SIGHUP)
            # One line may have been on its way; after a second one it works on.
            for _ in range(2):
                line = process.stderr.readline()
                require(is_progress(line), f"SIGHUP ignored: {line!r}")
            process.send_signal(signal.SIGTERM)

        stopped(line, folder, "SIGHUP ignored, then SIGTERM", hang_up_and_end, STATUS[signal.SIGTERM],
                ["vdb_shell: stopped by SIGTERM\n"], ignored=[signal.SIGHUP])
        stopped(line, folder, "a second of processor time", lambda process: None, STATUS[signal.SIGXCPU],
                ["vdb_shell: stopped by SIGXCPU: the limit on processor time is reached\n"], seconds=1)
        unread_pipe(command)


if __name__ == "__main__":
    sys.exit(status_of(main))
