#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Tables of docs/growth.md: what halving and doubling each number of GrowthSchedule does.

    schedule.py PROBE MESHES COLLECTION [--only NAME,...] [--keep FILE] [--write docs/growth.md]

PROBE is the program schedule_probe (built with -DVDB_SHELL_BENCHMARKS=ON), MESHES a folder with
paper/, artist/ and scans/, COLLECTION one with koala_low_resolution.obj and hand_closed.obj of
odedstein-meshes. The numbers were chosen on the meshes of one half and are checked on the other
(halves.py). Per half: the mean change of the fill, in thousandths of the solid, and the mean factor on the
time of growth (CPU time; geometric mean). Numbers that change neither half's fill by a fifth of a thousandth are only named. --keep: the probe's lines, used again if the file is
there. --write: puts the tables between the marks in that page instead of printing them.
"""
import argparse
import collections
import math
import pathlib
import subprocess
import sys

from halves import half_of

TUNED = "cow bunny_low_resolution bend knot rocker-arm".split()
JUDGED = "dragon_small_resolution glass bowl koala_low_resolution hand_closed".split()
FLAT = 0.2 # thousandths of the solid; the meshes' own scatter is about half a thousandth (docs/measurements/tried.md)
BEGIN, END = "<!-- schedule.py begins -->", "<!-- schedule.py ends -->"


def file_of(folders, name):
    """The paper's mesh where there are several of one name."""
    order = {"paper": 0, "artist": 1, "scans": 2}
    found = [p for folder in folders for p in folder.rglob(name + ".obj")]
    if not found:
        sys.exit(f"{name}.obj is not in {' or '.join(map(str, folders))}")
    return min(found, key=lambda p: (order.get(p.parent.name, 3), p))


def measure(probe, folders, only, keep):
    if keep and keep.exists():
        return keep.read_text()
    files = [str(file_of(folders, name)) for name in TUNED + JUDGED]
    text = subprocess.run([probe, *(["--only", only] if only else []), *files], check=True,
                          stdout=subprocess.PIPE, text=True).stdout
    if keep:
        keep.write_text(text)
    return text


def read(text):
    """shells[mesh][(number, factor)] = (fill, seconds), and triangles[mesh]."""
    shells, triangles = collections.defaultdict(dict), {}
    for line in text.splitlines():
        mesh, count, number, factor, fill, seconds = line.split("\t")
        shells[mesh][number, float(factor)] = float(fill), float(seconds)
        triangles[mesh] = int(count)
    return shells, triangles


def change(shells, half, number, factor):
    """Mean change of fill in thousandths, mean factor on time; None where nothing was measured."""
    swept = [shells[m] for m in half if (number, factor) in shells.get(m, {})]
    if not swept:
        return None
    fill = sum(s[number, factor][0] - s["default", 1.0][0] for s in swept) / len(swept)
    time = math.exp(sum(math.log(s[number, factor][1] / s["default", 1.0][1]) for s in swept) / len(swept))
    return 1000 * fill, time


def cell(value):
    if value is None:
        return "", ""
    fill, time = value
    return ("0" if abs(fill) < 0.05 else f"{fill:+.1f}"), f"{time:.2f}"


def default_table(shells, triangles):
    yield "| mesh | half | triangles | fill | seconds |"
    yield "|---|---|---|---|---|"
    for half, names in (("tuned", TUNED), ("judged", JUDGED)):
        for mesh in names:
            if mesh in shells:
                fill, seconds = shells[mesh]["default", 1.0]
                yield f"| {mesh} | {half} | {triangles[mesh]:,} | {fill:.4f} | {seconds:.2f} |"


def bears_on_fill(values):
    """Whether any of the changes is one of the fill by FLAT or more."""
    return any(value and abs(value[0]) >= FLAT for value in values)


def sweep_table(shells):
    """Rows of the numbers that bear on the fill, and the names of the others."""
    yield "| | halved: tuned | | judged | | doubled: tuned | | judged | |"
    yield "|---|---|---|---|---|---|---|---|---|"
    yield "| number | fill | time | fill | time | fill | time | fill | time |"
    numbers = list(dict.fromkeys(n for s in shells.values() for n, _ in s if n != "default"))
    flat = []
    for number in numbers:
        values = [change(shells, half, number, factor) for factor in (0.5, 2.0) for half in (TUNED, JUDGED)]
        if bears_on_fill(values):
            yield f"| `{number}` | " + " | ".join(c for value in values for c in cell(value)) + " |"
        else:
            flat.append(f"`{number}`")
    yield ""
    yield f"Neither halved nor doubled do these change the fill of a half by {FLAT} thousandths: {', '.join(flat)}."


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("probe")
    parser.add_argument("meshes", type=pathlib.Path)
    parser.add_argument("collection", type=pathlib.Path)
    parser.add_argument("--only", default="")
    parser.add_argument("--keep", type=pathlib.Path)
    parser.add_argument("--write", type=pathlib.Path)
    options = parser.parse_args()
    for names, half in ((TUNED, "tuning"), (JUDGED, "judging")):
        wrong = [name for name in names if half_of(name) != half]
        if wrong:
            sys.exit(f"not of the half {half}: {', '.join(wrong)}")
    shells, triangles = read(measure(options.probe, [options.meshes, options.collection], options.only, options.keep))
    tables = "\n".join([*default_table(shells, triangles), "", *sweep_table(shells)])
    if not options.write:
        print(tables)
        return 0
    page = options.write.read_text()
    before, rest = page.split(BEGIN)
    options.write.write_text(f"{before}{BEGIN}\n\n{tables}\n\n{END}{rest.split(END)[1]}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
