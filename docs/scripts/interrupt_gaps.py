#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""How long the stages of a build work without asking the caller's interrupter, for docs/reliability.md.

    interrupt_gaps.py PROBE docs/reliability.md MESH ...

PROBE is the program interrupt_gaps (built with -DVDB_SHELL_BENCHMARKS=ON). For each mesh the default job: the longest gap of a
stage by the clock, on all threads, and in processor time of the thread that asks, which other work on the machine does not change.
"""
import argparse
import pathlib
import subprocess

from runs import replace_tables, table


def arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("probe")
    parser.add_argument("page", type=pathlib.Path)
    parser.add_argument("meshes", type=pathlib.Path, nargs="+")
    return parser.parse_args()


def gaps_of(probe, mesh):
    """By stage: questions, seconds of the clock, seconds of the thread, greatest step of the percent. Names in small letters, for
    OpenVDB's tools have some with capitals; what lies before or after stages counts as one."""
    gaps = {}
    for line in subprocess.run([probe, mesh], check=True, capture_output=True, text=True).stdout.splitlines():
        name, *figures = line.split("\t")
        stage = "between stages" if name.split()[0] in ("before", "after", "outside") else name.lower()
        asked, *rest = (float(figure) for figure in figures)
        old = gaps.get(stage, [0, 0, 0, 0])
        gaps[stage] = [old[0] + asked, *(max(pair) for pair in zip(old[1:], rest))]
    return gaps


def main():
    wanted = arguments()
    rows = []
    for mesh in wanted.meshes:
        for stage, (asked, clock, thread, step) in gaps_of(wanted.probe, mesh).items():
            rows.append([mesh.stem, stage, f"{asked:,.0f}", f"{clock:.2f}", f"{thread:.2f}", f"{step:.0f}" if step else ""])
    head = ["surface", "stage", "asked", "longest gap, s", "the same of the thread, s", "greatest step, percent"]
    replace_tables(wanted.page, table(head, rows), "interrupt gaps")


if __name__ == "__main__":
    main()
