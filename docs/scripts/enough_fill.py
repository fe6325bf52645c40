#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""What --enough-fill gives and takes, for docs/measurements/enough_fill.md.

    enough_fill.py COMMAND docs/measurements/enough_fill.md FOLDER ... [--meshes LIST] [--smallest TRIANGLES]

Meshes and folders as for scan_figures.py, which has the list; those with fewer triangles than --smallest (15,000) are left
out. Each build is one run on one thread without a file, and its time the processor's, over that of the default on the
same mesh: so other work on the machine matters little.
"""
import argparse
import pathlib
import statistics

from runs import build, replace_tables, table
from scan_figures import meshes_of

RUNS = {"0.9": ["--enough-fill", "0.9"], "0.95": ["--enough-fill", "0.95"], "0.97": ["--enough-fill", "0.97"],
        "0.98": ["--enough-fill", "0.98"], "default": [], "0.99": ["--enough-fill", "0.99"],
        "0.995": ["--enough-fill", "0.995"], "for speed": ["--for", "speed"],
        "three tets, 0.9855": ["--prism-test", "chosen-tets", "--enough-fill", "0.9855"],
        "three tets": ["--prism-test", "chosen-tets"],
        "three tets, 0.995": ["--prism-test", "chosen-tets", "--enough-fill", "0.995"], "thickest": ["--thickest"]}


def measured(command, mesh, default):
    rows = {name: build(command, mesh, flags) if flags else default for name, flags in RUNS.items()}
    for name, row in rows.items():
        if row["exit"] != 0 or not row["certified"]:
            raise SystemExit(f"{mesh}, {name}: {row['message'] or 'not certified'}")
    return rows


def cell(rows, name):
    return f"{rows[name]['fill']:.4f}, {rows[name]['seconds'] / rows['default']['seconds']:.2f}"


def mean_cell(all_rows, name):
    fill = statistics.mean(rows[name]["fill"] for rows in all_rows)
    times = statistics.geometric_mean(rows[name]["seconds"] / rows["default"]["seconds"] for rows in all_rows)
    return f"{fill:.4f}, {times:.2f}"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("command")
    parser.add_argument("page", type=pathlib.Path)
    parser.add_argument("folders", type=pathlib.Path, nargs="+")
    parser.add_argument("--meshes", type=pathlib.Path,
                        default=pathlib.Path(__file__).parent.parent / "measurements/scan_meshes.txt")
    parser.add_argument("--smallest", type=int, default=15000)
    options = parser.parse_args()
    lines, by_half = [], {}
    meshes, note = meshes_of(options)
    for name, half, mesh in meshes:
        default = build(options.command, mesh, [])
        if default.get("triangles", options.smallest) < options.smallest:
            continue
        rows = measured(options.command, mesh, default)
        by_half.setdefault(half, []).append(rows)
        lines.append([name, half, f"{default['triangles']:,}", *(cell(rows, run) for run in RUNS)])
        print(" ".join(lines[-1]), flush=True)
    lines += [[f"mean of {half}", half, "", *(mean_cell(rows, run) for run in RUNS)] for half, rows in by_half.items()]
    replace_tables(options.page, note + table(["mesh", "half", "triangles", *RUNS], lines))


if __name__ == "__main__":
    main()
