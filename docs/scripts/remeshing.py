#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Time and triangles of --remesh-to, for docs/measurements/remeshing.md.

    remeshing.py COMMAND docs/measurements/remeshing.md MESH|NAME=MESH ... [--before OTHER_COMMAND]

Each mesh is remeshed to half of its triangles. NAME: as the lists of halves have it, where that is not the file's name.
--before: with an earlier build too. One thread.
"""
import argparse
import pathlib
import statistics

from halves import HALVES, half_of
from runs import build, replace_tables, table


def figures(report):
    remesh = report["remesh"]
    seconds = {stage["stage"]: stage["seconds"] for stage in report["stages"]}
    farthest = max(remesh["input_to_result"]["max"], remesh["result_to_input"]["max"])
    return {"before": remesh["triangles_before"], "wanted": remesh["triangles_wanted"], "after": remesh["triangles"],
            "seconds": seconds["remesh"], "angle": remesh["after"]["mean_min_angle_degrees"],
            "narrow": remesh["after"]["triangles_under_20_degrees"], "distance": farthest / remesh["tolerance"],
            "fill": report["volume"]["fill"], "repeats": remesh["repeats"]}


def triangles_of(command, path):
    done = build(command, path, ["--samples", "0", "--for", "speed"], lambda report: {"triangles": report["mesh"]["triangles"]})
    if done["exit"] != 0:
        raise SystemExit(f"{path}: {done['message']}")
    return done["triangles"]


def cells(done):
    return ([f"{done['after']:,}", f"{done['seconds']:.1f}", f"{done['angle']:.1f}", f"{done['narrow']:,}",
             str(done["repeats"]), f"{done['fill']:.4f}"] if done else [""] * 6)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("command")
    parser.add_argument("page", type=pathlib.Path)
    parser.add_argument("meshes", nargs="+")
    parser.add_argument("--before")
    a = parser.parse_args()
    rows = []
    for mesh in a.meshes:
        name, path = mesh.split("=", 1) if "=" in mesh else (pathlib.Path(mesh).stem, mesh)
        flags = ["--remesh-to", str(triangles_of(a.command, path) // 2), "--samples", "0"]
        row = {"name": name, "half": half_of(name), "now": build(a.command, path, flags, figures),
               "before": build(a.before, path, flags, figures) if a.before else None}
        rows.append(row)
        print(name, row["half"], cells(row["before"]), cells(row["now"]), flush=True)
    summary = []
    for half in HALVES:
        of_half = [row for row in rows if row["half"] == half and row["before"]]
        if of_half:
            ratios = [row["now"]["seconds"] / row["before"]["seconds"] for row in of_half]
            summary.append(f"{half}, {len(of_half)} meshes: {statistics.geometric_mean(ratios):.2f} of the time before in the geometric mean, "
                           f"{max(ratios):.2f} at most.")
    head = ["mesh", "half", "triangles", "wanted",
            *(f"{what}, {when}" for when in ("before", "now")
              for what in ("triangles", "seconds", "mean smallest angle", "under 20 degrees", "repeats", "fill")),
            "farthest / tolerance"]
    lines = [[row["name"], row["half"], f"{row['now']['before']:,}", f"{row['now']['wanted']:,}", *cells(row["before"]),
              *cells(row["now"]), f"{row['now']['distance']:.2f}"] for row in rows]
    replace_tables(a.page, [*summary, "", *table(head, lines)])


if __name__ == "__main__":
    main()
