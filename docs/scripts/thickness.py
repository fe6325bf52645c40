#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Measures fill and CPU seconds of each clean mesh and of each lever, and writes the tables of docs/thickness.md.

    thickness.py COMMAND MESH_FOLDER docs/thickness.md [--quick] [--results FILE.json]

COMMAND is the vdb_shell binary. --quick leaves out the meshes of more than 5000 triangles. --results keeps the
finished runs in a file and takes them from there the next time; delete it when the command has changed.
"""
import pathlib

from runs import CLEAN_MESHES, METHODS, Results, arguments, build, replace_tables, table

FLAGS = ["--resolution", "128", "--samples", "20000"]
BIG_MESHES = ["paper/knot", "artist/fandisk", "artist/cheburashka", "artist/rocker-arm"]
LEVER_MESHES = ["paper/diku", "paper/lamp", "paper/glass", "paper/cow", "paper/bunny_low_resolution"]
LEVERS = ["--no-free-moves", "--no-soft-contacts", "--no-smooth-directions", "--no-flips", "--no-top-down",
          "--no-grow-lines", "--no-mend-directions"]


def cells(run):
    if run is None:
        return ["not run", ""]
    if run["exit"] != 0:
        return [f"**FAILED, exit {run['exit']}**", ""]
    flaw = "" if run["certified"] and not run["in_several"] else " **FAILED**"
    return [f"{run['fill']:.3f}{flaw}", f"{run['seconds']:.1f}"]


def method_rows(runs):
    rows = []
    for name in CLEAN_MESHES:
        found = [runs.get(f"{name}, {method}") for method in METHODS]
        triangles = next((str(run["triangles"]) for run in found if run and run["exit"] == 0), "")
        rows.append([name, triangles] + [text for run in found for text in cells(run)])
    return rows


def mean_lines(runs):
    lines = []
    for method in METHODS:
        found = {name: runs.get(f"{name}, {method}") for name in CLEAN_MESHES}
        fills = {name: run["fill"] for name, run in found.items()
                 if name.startswith("paper/") and run and run["exit"] == 0}
        if fills:
            low = min(fills, key=fills.get)
            lines.append(f"`{method}`, {len(fills)} `paper/` meshes: mean fill {sum(fills.values()) / len(fills):.4f}, "
                         f"least {fills[low]:.3f} ({low}).")
    return lines


def lever_rows(runs):
    rows = []
    for lever in ["all on", *LEVERS]:
        found = [runs.get(f"{name}, {lever}") if lever != "all on" else runs.get(f"{name}, thickest")
                 for name in LEVER_MESHES]
        rows.append([f"`{lever}`" if lever.startswith("-") else lever] + [text for run in found for text in cells(run)])
    return rows


def write_page(page, runs):
    built = [run for run in runs.values() if run["exit"] == 0]
    certified = sum(run["certified"] for run in built)
    head = ["mesh", "triangles"] + [f"{method} {what}" for method in METHODS for what in ("fill", "CPU s")]
    lever_head = ["levers"] + [f"{name.split('/')[1]} {what}" for name in LEVER_MESHES for what in ("fill", "CPU s")]
    replace_tables(page, [
        f"{len(runs)} runs, {len(built)} shells built, {certified} certified.", "", "### Methods", "",
        *table(head, method_rows(runs)), "", *mean_lines(runs), "",
        "### Levers, `--method thickest` with one lever off", "", *table(lever_head, lever_rows(runs))])


def main():
    options = arguments(__doc__)
    results = Results(options.results)
    jobs = [(name, method, method, []) for name in CLEAN_MESHES for method in METHODS if name not in BIG_MESHES]
    jobs += [(name, lever, "thickest", [lever]) for name in LEVER_MESHES for lever in LEVERS]
    if not options.quick:
        jobs += [(name, method, method, []) for name in BIG_MESHES for method in METHODS]
    for name, title, method, extra in jobs:
        key = f"{name}, {title}"
        if key in results.runs:
            continue
        run = build(options.command, options.folder / f"{name}.obj", [*FLAGS, "--method", method, *extra])
        results.keep(key, run)
        print(f"{key}: {cells(run)}", flush=True)
        write_page(options.page, results.runs)
    write_page(options.page, results.runs)


if __name__ == "__main__":
    main()
