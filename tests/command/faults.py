#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Lets calls of the system fail, allocations fail and signals come while the command writes several
files, and looks at the folder afterwards: all files old or all new, nothing left over, a documented
status, one line that says why.

    faults.py COMMAND MESH FAIL_NTH_CALL.so FAIL_NTH_NEW.so [--signals N] [--allocations N] [--large MESH]

Prints a table (docs/reliability.md has one of a longer run) and fails on the first violation."""
import argparse
import os
import pathlib
import random
import signal
import subprocess
import sys
import tempfile
import time

NAMES = ["s.vdb", "s.points.vdb", "s.vtu", "s.node", "s.ele", "s.face", "s.mesh", "s.png", "i.obj", "s.bgeo", "s.usda", "s.json"]
WRITE_ERROR, OUT_OF_MEMORY, READ_ERROR = 5, 9, 3


class Violation(Exception):
    pass


class Folder:
    """Outputs of one call, over old files or where nothing is."""

    def __init__(self, path, with_old, names=NAMES):
        self.path, self.with_old, self.names = pathlib.Path(path), with_old, names

    def fill(self):
        for file in self.path.iterdir():
            file.unlink()
        if self.with_old:
            for name in self.names:
                (self.path / name).write_text("old " + name)

    def state(self):
        """'old', 'new', or what is wrong."""
        there = sorted(file.name for file in self.path.iterdir())
        strange = [name for name in there if name not in self.names]
        if strange:
            return "left over: " + ", ".join(strange)
        old = [n for n in self.names if (self.is_old(n) if self.with_old else n not in there)]
        if len(old) == len(self.names):
            return "old"
        return "new" if not old and len(there) == len(self.names) else "old are " + ", ".join(old)

    def is_old(self, name):
        file = self.path / name
        return file.exists() and file.read_bytes() == ("old " + name).encode()


def command_line(command, mesh, folder):
    out = [word for name in NAMES if name not in ("s.points.vdb", "s.ele", "s.face", "s.json") for word in ("-o", str(folder.path / name))]
    return [command, "build", str(mesh), "--resolution", "16", "--samples", "0", "-q", "--points", "beside", *out,
            "--report", str(folder.path / "s.json")]


def lines(command, mesh, shell, folder):
    """What signals are sent to, and the files that each writes."""
    build = command_line(command, mesh, folder)
    outputs = build[build.index("--points"):build.index("--report")]
    return {"build": (build, NAMES), "convert": ([command, "convert", str(shell), *outputs], NAMES[:-1]),
            "inspect": ([command, "inspect", str(mesh)], []), "check": ([command, "check", str(shell)], []),
            "info": ([command, "info", str(shell)], [])}


def require(condition, text):
    if not condition:
        raise Violation(text)


def status_of(main):
    """Runs it; 1 where something is not as it has to be, which is printed."""
    try:
        main()
    except Violation as violation:
        print("VIOLATION:", violation)
        return 1
    return 0


def is_one_line(text):
    return text.endswith("\n") and text.count("\n") == 1 and len(text) > 1


def run(line, environment):
    done = subprocess.run(line, env={**os.environ, **environment}, capture_output=True, text=True, errors="replace", timeout=120)
    return done.returncode, done.stderr


def calls(args, folder, log, more):
    """The n-th call fails, for every n until none does."""
    n = 0
    while True:
        n += 1
        folder.fill()
        log.unlink(missing_ok=True)
        status, error = run(command_line(args.command, args.mesh, folder),
                            {"LD_PRELOAD": args.calls, "FAULT_FOLDER": str(folder.path), "FAULT_AT": str(n),
                             "FAULT_LOG": str(log), **more})
        happened = log.read_text() if log.exists() else ""
        at = f"call {n} ({happened}): status {status}, {folder.state()}, {error!r}"
        if not happened:
            require(status == 0 and folder.state() == "new" and not error, at)
            require(n > 1, "no call failed: the library that fails them does nothing")
            return n - 1
        require(status == WRITE_ERROR and folder.state() == "old" and is_one_line(error), at)


def allocations(args, line, folder, log):
    """Sampled, the first ones and then ever more rarely."""
    tried, n, statuses = 0, 1, {}
    while tried < args.allocations:
        folder.fill()
        log.unlink(missing_ok=True)
        status, error = run(line, {"LD_PRELOAD": args.new, "FAULT_NEW": str(n), "FAULT_LOG": str(log)})
        if not log.exists():
            break
        tried += 1
        statuses[status] = statuses.get(status, 0) + 1
        state = folder.state()
        at = f"allocation {n}: status {status}, {state}, {error!r}"
        # Some are asked for by code that can do without: then all is as if nothing had been.
        require(not folder.names or state == ("new" if status == 0 else "old"), at)
        require(status in (0, OUT_OF_MEMORY), at)
        require(is_one_line(error) if status == OUT_OF_MEMORY else not error, at)
        n += max(1, n // args.sparse)
    # Every command allocates, so without these two nothing was tested.
    require(tried > 0, "no allocation failed: the library that fails them does nothing")
    require(OUT_OF_MEMORY in statuses, f"none of {tried} allocations that failed ended with status {OUT_OF_MEMORY}")
    return tried, statuses


def signals(line, folder, count):
    """At random moments; the longest time from the signal to the end."""
    worst, seen = 0.0, {}
    generator = random.Random(1)
    folder.fill()
    began = time.monotonic()
    require(subprocess.run(line, capture_output=True).returncode == 0, "it fails without any signal")
    whole = time.monotonic() - began
    for k in range(count):
        folder.fill()
        number = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)[k % 3]
        process = subprocess.Popen(line, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
        time.sleep(generator.uniform(0, 1.1 * whole))
        sent = time.monotonic()
        process.send_signal(number)
        error = process.communicate(timeout=120)[1]
        latency = time.monotonic() - sent
        status, state = process.returncode, folder.state()
        at = f"{number.name} after {sent - began:.3f} s: status {status}, {state}, {error!r}"
        # Before the program has begun the signal's own action ends it.
        stopped = status in (128 + number, -number)
        require(stopped or status == 0, at)
        require(state == "new" if status == 0 and folder.names else state in ("old", "new"), at)
        # A signal that came while files were renamed has waited, and says nothing any more.
        waited = bool(folder.names) and state == "new"
        told = status == 128 + number and is_one_line(error)
        require(told or (not error and (status != 128 + number or waited)), at)
        if status == 128 + number:
            worst = max(worst, latency)
        seen[state if stopped else "finished"] = seen.get(state if stopped else "finished", 0) + 1
    return worst, seen


def main():
    parser = argparse.ArgumentParser()
    for name in ("command", "mesh", "calls", "new"):
        parser.add_argument(name)
    parser.add_argument("--signals", type=int, default=40)
    parser.add_argument("--allocations", type=int, default=200)
    parser.add_argument("--sparse", type=int, default=8)
    parser.add_argument("--large", help="a mesh for signals that takes seconds")
    args = parser.parse_args()
    with tempfile.TemporaryDirectory() as work:
        log = pathlib.Path(work) / "log"
        outputs = pathlib.Path(work) / "outputs"
        outputs.mkdir()
        over, fresh = Folder(outputs, True), Folder(outputs, False)
        print("calls, over old files:", calls(args, over, log, {}), flush=True)
        print("calls, where nothing was:", calls(args, fresh, log, {}), flush=True)
        print("calls, without hard links:", calls(args, over, log, {"FAULT_NO_LINKS": "1"}), flush=True)
        shell = pathlib.Path(work) / "shell.vdb"
        make = [args.command, "build", args.mesh, "--resolution", "16", "--samples", "0", "-q", "-o", shell]
        subprocess.run(make, check=True)
        for name, (line, names) in lines(args.command, args.mesh, shell, over).items():
            print(f"allocations, {name}:", *allocations(args, line, Folder(outputs, True, names), log), flush=True)
        mesh = args.large or args.mesh
        subprocess.run([mesh if word == args.mesh else word for word in make], check=True)
        for name, (line, names) in lines(args.command, mesh, shell, over).items():
            worst, seen = signals(line, Folder(outputs, True, names), args.signals)
            print(f"signals, {name}: {args.signals}, worst answer {1000 * worst:.0f} ms, {seen}", flush=True)


if __name__ == "__main__":
    sys.exit(status_of(main))
