#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Times `build`, `inspect`, `repair` and `build --wrap` on surfaces that are hard for some stage, for growing numbers of
triangles, and writes the tables of docs/measurements/cost_of_inputs.md.

    cost_of_inputs.py COMMAND docs/measurements/cost_of_inputs.md [--sizes N ...] [--inputs NAME ...] [--results FILE]
                      [--commands NAME ...] [--limit SECONDS] [--only-write]

CPU seconds of one thread. The exponent is that of the last two sizes: seconds are about those of n to that power. A run
that takes more CPU seconds than the limit is ended, and larger ones of that input are not tried. --results keeps finished
runs.
"""
import argparse
import math
import os
import pathlib
import resource
import signal
import struct
import subprocess
import tempfile

from cost_inputs import MAKERS
from runs import Results, replace_tables, table

COMMANDS = {"build": lambda mesh, folder: ["build", "--resolution", "64", "--samples", "0", "-q", mesh, "-o", folder + "/shell.vtu"],
            "inspect": lambda mesh, folder: ["inspect", mesh],
            "repair": lambda mesh, folder: ["repair", mesh, "-o", folder + "/mended.ply"],
            "wrap": lambda mesh, folder: ["build", "--wrap", "--wrap-resolution", "64", "--resolution", "64", "--samples", "0", "-q", mesh, "-o",
                                         folder + "/wrapped.vtu"]}


def write_ply(path, points, triangles):
    head = ("ply\nformat binary_little_endian 1.0\nelement vertex %d\nproperty float x\nproperty float y\n"
            "property float z\nelement face %d\nproperty list uchar int vertex_indices\nend_header\n")
    with open(path, "wb") as file:
        file.write((head % (len(points), len(triangles))).encode())
        file.write(b"".join(struct.pack("<3f", *point) for point in points))
        file.write(b"".join(struct.pack("<B3i", 3, *triangle) for triangle in triangles))


def finishes(command, words, limit):
    """Whether it ends within the limit. The exit status is left aside, since most inputs are refused, but for wraps: there
    always is one."""
    line = [command, words[0], "--threads", "1", *words[1:]] if words[0] == "build" else [command, *words]
    ended = subprocess.run(line, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, check=False,
                           preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_CPU, (limit, limit + 5)))
    # What the command says of a signal, and the system's word where it ended before it could.
    if ended.returncode in (128 + signal.SIGXCPU, -signal.SIGXCPU, -signal.SIGKILL):
        return False
    if "--wrap" in words and ended.returncode != 0:
        raise SystemExit(f"exit status {ended.returncode}: {' '.join(line)}")
    return True


def seconds(command, words, limit):
    """CPU seconds, or None where the limit was not enough."""
    before = os.times()
    done = finishes(command, words, limit)
    after = os.times()
    spent = after.children_user + after.children_system - before.children_user - before.children_system
    return spent if done else None


def row_of(name, command, runs, sizes):
    cells, last = [], None
    for n in sizes:
        run = runs.get(f"{name} {command} {n}")
        if run is None:
            cells.append("")
            continue
        cells.append("over the limit" if run["seconds"] is None else f"{run['seconds']:.2f}")
        if run["seconds"]:
            last = (last or []) + [(run["triangles"], run["seconds"])]
    exponent = ""
    if last and len(last) > 1 and last[-1][1] > .2:
        (n0, s0), (n1, s1) = last[-2:]
        exponent = f"{math.log(s1 / s0) / math.log(n1 / n0):.1f}"
    return [name, command, *cells, exponent]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("command")
    parser.add_argument("page", type=pathlib.Path)
    parser.add_argument("--sizes", type=int, nargs="+", default=[8000, 32000, 128000])
    parser.add_argument("--inputs", nargs="+", choices=MAKERS, default=list(MAKERS))
    parser.add_argument("--commands", nargs="+", choices=COMMANDS, default=list(COMMANDS))
    parser.add_argument("--limit", type=int, default=60)
    parser.add_argument("--results")
    parser.add_argument("--only-write", action="store_true", help="the table of what --results has")
    options = parser.parse_args()
    results = Results(options.results)
    for name in options.inputs if not options.only_write else []:
        slow = set()
        for n in options.sizes:
            points, triangles = MAKERS[name](n)
            with tempfile.TemporaryDirectory() as folder:
                mesh = folder + "/input.ply"
                write_ply(mesh, points, triangles)
                for command in options.commands:
                    key = f"{name} {command} {n}"
                    if command in slow or key in results.runs:
                        continue
                    spent = seconds(options.command, COMMANDS[command](mesh, folder), options.limit)
                    results.keep(key, {"seconds": spent, "triangles": len(triangles)})
                    if spent is None:
                        slow.add(command)
    head = ["input", "command", *(f"{n:,}" for n in options.sizes), "exponent"]
    rows = [row_of(name, command, results.runs, options.sizes) for name in options.inputs
            for command in options.commands if any(f"{name} {command} {n}" in results.runs for n in options.sizes)]
    replace_tables(options.page, table(head, rows))


if __name__ == "__main__":
    main()
