#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Sends SIGINT, SIGTERM, SIGHUP, SIGPIPE and SIGXCPU at random moments to every command while it works on a large mesh, and
writes the table of docs/reliability.md: how long the command takes to end, worst of many.

    signal_latencies.py COMMAND MESH docs/reliability.md [--signals N] [--results FILE] [--commands NAME ...] [--stages]
                         [--section NAME]

Looks at the folder after each signal: outputs all old or all new, nothing else in it, exit status 128 and the signal's number, or
0 where the work was done. On a machine with other work the clock says little, so what is held against the limit is the time
that the processor spent on the command between signal and end; both are told. --stages prints which stage of `build` each signal met.
--results keeps what was measured.
"""
import argparse
import collections
import os
import pathlib
import random
import signal
import statistics
import subprocess
import tempfile
import time

from runs import Results, replace_tables, table

SIGNALS = signal.SIGINT, signal.SIGTERM, signal.SIGHUP, signal.SIGPIPE, signal.SIGXCPU
WANTED_SECONDS = .5


def lines(command, mesh, shell, out):
    """What signals are sent to, and the files that each writes."""
    def writing(words, *names):
        return [*words, *(word for name in names for word in ("-o", str(out / name)))], names

    def build(*more):
        return writing([command, "build", mesh, "-q", "--progress", *more], "s.vdb", "s.vtu", "s.bgeo")

    return {"build": build(), "build --repair": build("--repair"), "build --thickest --layers 3": build("--thickest", "--layers", "3"),
            "build --taper": build("--taper"), "build --for simulation": build("--for", "simulation"), "build --side both": build("--side", "both"),
            "build --wrap": build("--wrap"), "build --remesh-to 50000": build("--remesh-to", "50000"),
            "inspect": writing([command, "inspect", mesh], "i.ply"), "repair": writing([command, "repair", mesh], "r.ply"),
            "info": ([command, "info", shell], ()), "check": ([command, "check", shell], ()),
            "compare": writing([command, "compare", shell, shell], "c.png"),
            "pose": writing([command, "pose", shell, mesh], "p.vdb", "p.vtu"),
            "volumes": writing([command, "volumes", shell, "--volumes", "depth,rest,layer"], "v.vdb"),
            "page": writing([command, "page", shell], "p.html"),
            "convert": writing([command, "convert", shell], "c.vdb", "c.vtu", "c.usda", "c.geo")}


def fill(out, names):
    for file in out.iterdir():
        file.unlink()
    for name in names:
        (out / name).write_text("old")


def state(out, names):
    """Which of the outputs are new; None where something else lies there."""
    if sorted(file.name for file in out.iterdir()) != sorted(names):
        return None
    return [(out / name).read_bytes() != b"old" for name in names]


def processor_seconds(process):
    """Of all threads so far, in steps of a hundredth of a second."""
    fields = pathlib.Path(f"/proc/{process.pid}/stat").read_text().rsplit(")", 1)[1].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


def send(line, names, out, delay, number):
    """One run: seconds from the signal to the end, the last stage that was named, and what is wrong."""
    fill(out, names)
    with tempfile.TemporaryFile("w+") as errors:
        process = subprocess.Popen(line, stdout=subprocess.DEVNULL, stderr=errors)
        time.sleep(delay)
        began, spent = time.monotonic(), processor_seconds(process)
        # Not by the object, which would wait for a process that has ended.
        os.kill(process.pid, number)
        # wait4 and not wait: only it tells the resources of this child alone.
        _, ended, usage = os.wait4(process.pid, 0)
        status = process.returncode = os.waitstatus_to_exitcode(ended)
        latency, spent = time.monotonic() - began, max(0, usage.ru_utime + usage.ru_stime - spent)
        errors.seek(0)
        said = errors.read().splitlines()
    stages = [text.split(": ", 1)[1] for text in said if text.startswith("vdb_shell: ") and "stopped by" not in text]
    new = state(out, names)
    wrong = []
    if status not in (0, 128 + number, -number):
        wrong.append(f"status {status}: {said[-1:]}")
    if new is None or len(set(new)) > 1 or (status == 0 and not all(new)):
        wrong.append("outputs are torn, or something is left over")
    if status == 128 + number and spent > WANTED_SECONDS:
        wrong.append(f"{spent:.2f} s")
    return {"seconds": latency if status == 128 + number else None, "processor": spent,
            "stage": stages[-1] if stages else "start", "wrong": wrong}


def series(line, names, out, count, seed):
    generator = random.Random(seed)
    fill(out, names)
    began = time.monotonic()
    subprocess.run(line, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, check=False)
    whole = time.monotonic() - began
    runs = [send(line, names, out, generator.uniform(0, 1.02 * whole), SIGNALS[k % len(SIGNALS)]) for k in range(count)]
    return {"whole": whole, "runs": runs}


def row(name, found):
    seconds = sorted(run["seconds"] for run in found["runs"] if run["seconds"] is not None)
    wrong = [text for run in found["runs"] for text in run["wrong"]]
    processor = [run["processor"] for run in found["runs"] if run["seconds"] is not None and "processor" in run]
    return [f"`{name}`", f"{found['whole']:.1f}", str(len(found["runs"])), str(len(seconds)),
            f"{1000 * statistics.median(seconds):.0f}" if seconds else "", f"{1000 * seconds[-1]:.0f}" if seconds else "",
            f"{1000 * max(processor):.0f}" if processor else "", str(len(wrong))]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("command")
    parser.add_argument("mesh")
    parser.add_argument("page", type=pathlib.Path)
    parser.add_argument("--signals", type=int, default=90)
    parser.add_argument("--results")
    parser.add_argument("--commands", nargs="+")
    parser.add_argument("--stages", action="store_true")
    parser.add_argument("--section", default="signals", help="which table of the page")
    options = parser.parse_args()
    # A shell ignores some of them for what runs in the background, and whoever it starts ignores them too.
    for number in SIGNALS:
        signal.signal(number, signal.SIG_DFL)
    results = Results(options.results)
    with tempfile.TemporaryDirectory() as work:
        shell, out = pathlib.Path(work) / "shell.vdb", pathlib.Path(work) / "out"
        out.mkdir()
        subprocess.run([options.command, "build", options.mesh, "-q", "-o", shell], check=True)
        for name, (line, names) in lines(options.command, options.mesh, str(shell), out).items():
            if name in results.runs or (options.commands and name not in options.commands):
                continue
            results.keep(name, series(line, names, out, options.signals, name))
            print(*row(name, results.runs[name]), *(run["wrong"] for run in results.runs[name]["runs"] if run["wrong"]), flush=True)
    if options.stages:
        stages = collections.defaultdict(list)
        for name, found in results.runs.items():
            for run in found["runs"]:
                if name.startswith("build") and run["seconds"] is not None:
                    stages[run["stage"]].append(run["seconds"])
        for stage, seconds in stages.items():
            print(f"{stage}: {len(seconds)} signals, worst {1000 * max(seconds):.0f} ms")
    rows = [row(name, found) for name, found in results.runs.items()]
    rows.append(["all", "", *(str(sum(int(each[k]) for each in rows)) for k in (2, 3)), "",
                 *(str(max(int(each[k] or 0) for each in rows)) for k in (5, 6)), str(sum(int(each[7]) for each in rows))])
    head = ["command", "seconds of a run", "signals", "answered", "median ms", "worst ms", "worst ms of the processor", "violations"]
    replace_tables(options.page, table(head, rows), options.section)


if __name__ == "__main__":
    main()
