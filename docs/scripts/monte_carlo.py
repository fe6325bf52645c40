#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""A million Monte Carlo points in every clean mesh, in both methods; writes the tables of docs/measurements/monte_carlo.md.

    monte_carlo.py COMMAND MESH_FOLDER docs/measurements/monte_carlo.md [--quick] [--results FILE]

--results keeps finished runs, so that a series can be continued; --quick leaves out the large meshes.
"""
import runs

SAMPLES = 1000000
RESOLUTION = 128


def main():
    options = runs.arguments(__doc__)
    results = runs.Results(options.results)
    rows, points, several = [], 0, 0
    for mesh in runs.CLEAN_MESHES:
        if options.quick and mesh.startswith("artist/"):
            continue
        row = [mesh]
        for method in runs.METHODS:
            key = f"{mesh} {method}"
            if key not in results.runs:
                results.keep(key, runs.build(options.command, options.folder / f"{mesh}.obj",
                                             ["--resolution", str(RESOLUTION), "--samples", str(SAMPLES), "--method", method]))
            run = results.runs[key]
            if run["exit"] != 0 or not run["certified"]:
                row += ["**FAILED**"] * 4
                continue
            points, several = points + run["samples"], several + run["in_several"]
            row += [str(run["in_several"]), str(run["in_none"]), f"{1 - run['in_none'] / run['samples']:.4f}", f"{run['fill']:.4f}"]
        rows.append(row)
    head = ["mesh"] + [f"{method}: {what}" for method in runs.METHODS for what in ("in two tets", "in none", "share in one", "fill")]
    runs.replace_tables(options.page, [f"{points} points in all, {several} of them in two tets.", "", *runs.table(head, rows)])


if __name__ == "__main__":
    main()
