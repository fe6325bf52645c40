#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The fill of parts whose flat walls are cut into needles, by builds of two versions, for docs/measurements/tried.md.

    needles.py BEFORE COMMAND PREFIX=FOLDER ... [--triangles 0 5000] [--flags "--for speed"] [--now=--retriangulate] [--never-run]

Of the parts of docs/measurements/machined.md, which have their halves and names from there, those of so many triangles (least and most)
that the page says are less than .99 full by default; and plates of needles, made here. Prints a table. --now has what the second
command is given besides; with it the table has the seconds of both as well. --never-run takes all parts of the folders with so many
triangles instead, collections that nothing was tuned with.
"""
import argparse
import math
import pathlib
import re
import statistics
import tempfile

from halves import half_of
from machined import figures, parts
from runs import build, table

PAGE = pathlib.Path(__file__).parent.parent / "measurements/machined.md"
ROW = re.compile(r"\| (\w+) \| (?:tuning|judging) \| ([\d,]+) \| [\d.]+ \| ([\d.]+)")


def wanted_names(least_triangles, most_triangles):
    rows = [ROW.match(line) for line in PAGE.read_text().splitlines()]
    return {row[1] for row in rows
            if row and least_triangles <= int(row[2].replace(",", "")) <= most_triangles and float(row[3]) < 0.99}


def write_plate(path, points_per_corner, half=50, radius=3, thickness=3):
    """A flat plate with rounded corners, whose faces are fans from corner to corner."""
    count = 4 * points_per_corner
    with open(path, "w") as out:
        for z in (0, thickness):
            for i in range(count):
                corner, step = divmod(i, points_per_corner)
                angle = math.pi / 2 * (corner + step / (points_per_corner - 1))
                x, y = (1 if corner in (0, 3) else -1), (1 if corner < 2 else -1)
                out.write(f"v {x * (half - radius) + radius * math.cos(angle):.9g} "
                          f"{y * (half - radius) + radius * math.sin(angle):.9g} {z}\n")
        fans = [(i, i + 1, (corner + 1) % 4 * points_per_corner) for corner in range(4)
                for i in range(corner * points_per_corner, (corner + 1) * points_per_corner - 1)]
        fans += [(0, points_per_corner, 2 * points_per_corner), (0, 2 * points_per_corner, 3 * points_per_corner)]
        band = [triangle for i in range(count) for j in [(i + 1) % count]
                for triangle in ((i, j, j + count), (i, j + count, i + count))]
        faces = band + [tuple(c + count for c in fan) for fan in fans] + [fan[::-1] for fan in fans]
        out.writelines(f"f {a + 1} {b + 1} {c + 1}\n" for a, b, c in faces)


def plates(folder):
    for points in (19, 20, 22, 25, 28, 31):
        path = pathlib.Path(folder) / f"plate_of_{points}_points_a_corner.obj"
        write_plate(path, points)
        yield path.stem, path


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("before")
    parser.add_argument("command")
    parser.add_argument("folders", nargs="*", type=lambda word: tuple(word.split("=", 1)))
    parser.add_argument("--triangles", type=int, nargs=2, default=[0, 5000], metavar=("LEAST", "MOST"))
    parser.add_argument("--flags", default="")
    parser.add_argument("--now", default="")
    parser.add_argument("--never-run", action="store_true")
    a = parser.parse_args()
    flags = [*a.flags.split(), "--samples", "0"]
    names, rows, means = wanted_names(*a.triangles), [], {}
    with tempfile.TemporaryDirectory() as folder:
        made = [] if a.triangles[0] > 0 or a.never_run else plates(folder)
        chosen = [*made, *(part for part in parts(a.folders) if part[0] in names or a.never_run)]
        for name, path in chosen:
            two = [build(a.before, path, flags, figures), build(a.command, path, [*flags, *a.now.split()], figures)]
            if any(one["exit"] != 0 for one in two) or not a.triangles[0] <= two[0]["triangles"] <= a.triangles[1]:
                continue
            half = "never run" if a.never_run else "made here" if path.parent == pathlib.Path(folder) else half_of(name)
            rows.append([name, half, f"{two[0]['triangles']:,}", *(f"{one['fill']:.4f}" for one in two),
                         str(two[1]["pins"] - two[1]["demanded"]), *(f"{one['seconds']:.1f}" for one in two if a.now)])
            means.setdefault(half, []).append([one[key] for key in ("fill", "seconds") for one in two])
    for half, of in means.items():
        fill_before, fill_now, *seconds = map(statistics.mean, zip(*of))
        rows.append([f"mean of {half} ({len(of)})", half, "", f"{fill_before:.4f}", f"{fill_now:.4f}", "",
                     *(f"{mean:.1f}" for mean in seconds if a.now)])
    head = ["part", "half", "triangles", "before", "now", "pins beyond demanded"]
    print("\n".join(table(head + ["s before", "s now"] * bool(a.now), rows)))


if __name__ == "__main__":
    main()
