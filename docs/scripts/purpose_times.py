#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Processor time of the purposes (--for) over that of the default job, for docs/measurements/shape.md.

    purpose_times.py COMMAND MESHES docs/measurements/shape.md [--largest TRIANGLES]

Each mesh of shape_meshes.txt of at most so many triangles (45,000) is built in turn by the default and for each purpose, twice; the
better of the two counts. Times are those of the processor, of all threads and without a file, so other work matters little. Geometric
means by half.
"""
import argparse
import json
import pathlib
import statistics
import tempfile

from halves import HALVES, read_halves
from runs import replace_tables, table, usage_of

AIMS = {"fewest-tets": 2, "simulation": 4}
LIST = pathlib.Path(__file__).parent.parent / "measurements/shape_meshes.txt"


def seconds(command, mesh, purpose, report):
    words = [command, "build", mesh, "-q", "--report", report, *([] if purpose == "default" else ["--for", purpose])]
    status, usage = usage_of(words)
    if status != 0:
        raise SystemExit(f"{mesh}: {purpose}: exit status {status}")
    return usage.ru_utime + usage.ru_stime


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("command", type=pathlib.Path)
    parser.add_argument("meshes", type=pathlib.Path)
    parser.add_argument("page", type=pathlib.Path)
    parser.add_argument("--largest", type=int, default=45000)
    options = parser.parse_args()
    rows, ratios = [], {(half, purpose): [] for half in HALVES for purpose in AIMS}
    with tempfile.TemporaryDirectory() as folder:
        report = pathlib.Path(folder) / "report.json"
        for name, half in read_halves(LIST).items():
            mesh = options.meshes / f"{name}.obj"
            times = {"default": min(seconds(options.command, mesh, "default", report) for _ in range(2))}
            triangles = json.loads(report.read_text())["mesh"]["triangles"]
            if triangles > options.largest:
                continue
            for purpose in AIMS:
                times[purpose] = min(seconds(options.command, mesh, purpose, report) for _ in range(2))
                ratios[half, purpose].append(times[purpose] / times["default"])
            rows.append([name, half, f"{triangles:,}", f"{times['default']:.2f}",
                         *(f"{times[purpose] / times['default']:.1f}" for purpose in AIMS)])
            print(" | ".join(rows[-1]), flush=True)
    rows += [[f"mean of {half}", half, "", "", *(f"{statistics.geometric_mean(ratios[half, purpose]):.1f}" for purpose in AIMS)]
             for half in HALVES]
    rows.append(["aim", "", "", "", *(f"{aim}" for aim in AIMS.values())])
    header = ["mesh", "half", "triangles", "default, s", *(f"{purpose} / default" for purpose in AIMS)]
    replace_tables(options.page, table(header, rows), "times")


if __name__ == "__main__":
    main()
