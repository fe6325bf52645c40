#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Shells outside and on both sides of five surfaces, for docs/measurements/outward.md.

    outward.py COMMAND MESH_FOLDER docs/measurements/outward.md

Each build is one run on one thread. Ends with an error where a shell is not certified or a sample lies in two tets.
"""
import sys

from runs import arguments, build, replace_tables, table
from triangles import read_obj

MESHES = ["paper/cow", "paper/teapot", "paper/knot", "paper/bunny_low_resolution", "paper/lamp"]
COMMON = ["--resolution", "128", "--samples", "20000"]
# Thickness as a share of the diagonal of the bounding box; none is the default.
RUNS = {"outward 0.05": ("outward", "0.05"), "outward, default": ("outward", None), "outward 0.2": ("outward", "0.2"),
        "both 0.2": ("both", "0.2")}


def diagonal(mesh):
    points, _ = read_obj(mesh)
    return sum((max(axis) - min(axis)) ** 2 for axis in zip(*points)) ** 0.5


def figures(report):
    volume = report["volume"]
    return {"sound": report["certificate"]["certified"] and report["coverage"]["in_several"] == 0,
            "outside": volume["outside"] / volume["solid"], "fill": volume["fill"]}


def cells(command, mesh, side, share):
    thickness = [] if share is None else ["--thickness", repr(float(share) * diagonal(mesh))]
    done = build(command, mesh, [*COMMON, "--side", side, *thickness], figures)
    if done["exit"] != 0 or not done["sound"]:
        raise SystemExit(f"{mesh.stem}, {side} {share}: {done}")
    return [f"{done['outside']:.2f}" if side == "outward" else f"{done['fill']:.3f}", f"{done['seconds']:.2f}"]


def main():
    a = arguments(__doc__)
    head = ["mesh", *(word for name, (side, _) in RUNS.items()
                      for word in (f"{name}: {'outside' if side == 'outward' else 'fill'}", "CPU s"))]
    rows = []
    for name in MESHES[:1] if a.quick else MESHES:
        mesh = a.folder / (name + ".obj")
        rows.append([name, *(cell for side, share in RUNS.values() for cell in cells(a.command, mesh, side, share))])
        print(rows[-1], file=sys.stderr, flush=True)
    replace_tables(a.page, table(head, rows))


if __name__ == "__main__":
    main()
