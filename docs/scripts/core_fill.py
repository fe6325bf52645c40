#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Measures shells whose void an outside program fills, and writes the table of docs/stages/fill_core.md. Needs numpy,
and gmsh and tetgen on PATH.

    core_fill.py COMMAND MESH_FOLDER docs/stages/fill_core.md [--meshes NAME ...] [--options "OPTIONS" ...]

The tets are read from the written .node and .ele by code that is not the library's. Their volumes are added up in whole
numbers, without any rounding, and so is that of the surface in the file that was read; the table says whether the two
are the same number.
"""
import argparse
import json
import pathlib
import shlex
import subprocess
import tempfile
from fractions import Fraction

import numpy as np

from runs import replace_tables, table
from tet_files import read_obj, read_tets
from tet_shapes import amips, dihedral_degrees

MESHES = ["paper/cow", "paper/bunny_low_resolution", "artist/fandisk", "paper/knot"]
OPTIONS = ["--layers 2 --thickness-scale 0.4", "--for simulation --core free", "--for simulation"]
PROGRAMS = ["tetgen", "gmsh"]


def whole_numbers(points, steps):
    return [[int(Fraction(float(x)) * steps) for x in point] for point in np.float32(points)]


def determinant(a, b, c):
    return (a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2])
            + a[2] * (b[0] * c[1] - b[1] * c[0]))


def less(p, q):
    return [p[0] - q[0], p[1] - q[1], p[2] - q[2]]


def same_volume(points, tets, surface, triangles):
    """Whether six times the volume of the tets is that which the triangles enclose."""
    # Of a float32 the denominator is a power of two, so the largest is a multiple of all.
    steps = max(Fraction(float(x)).denominator for x in np.float32(points).ravel())
    at, on = whole_numbers(points, steps), whole_numbers(surface, steps)
    filled = sum(determinant(*(less(at[tet[k]], at[tet[0]]) for k in (1, 2, 3))) for tet in tets)
    return filled == sum(determinant(*(on[k] for k in triangle)) for triangle in triangles)


def rows_of(command, mesh, options, program, folder):
    report, tets = folder / "report.json", folder / "tets.node"
    made = subprocess.run([command, "build", mesh, *shlex.split(options), "--core-fill", program, "-q", "--report",
                           report, "-o", tets], capture_output=True, text=True)
    if made.returncode:
        return ["refused: " + made.stderr.strip().splitlines()[-1].split(": ", 1)[-1].split("; ")[0].split(",")[0]]
    figures = json.loads(report.read_text())
    points, corners = read_tets(tets)
    surface, triangles = read_obj(mesh)
    core = figures["core_fill"]
    smallest, energy = dihedral_degrees(points, corners).min(1), amips(points, corners)
    seconds = {stage["stage"]: stage["seconds"] for stage in figures["stages"]}
    exact = same_volume(points, corners.tolist(), surface, triangles.tolist())
    count = len(triangles)
    return [f"{figures['tets']['tets'] / count:.2f}", f"{core['tets'] / count:.2f}", f"{len(corners) / count:.2f}",
            f"{core['volume'] / figures['volume']['solid']:.2%}", str(core["points"]),
            f"{core['min_dihedral_degrees']:.2g}", f"{(smallest < 5).mean():.2%}", f"{energy.mean():.2f}",
            "yes" if exact else "NO", f"{seconds['core fill']:.2f}", f"{sum(seconds.values()):.1f}"]


HEAD = ["mesh", "by", "shell", "core", "both", "core's volume", "points inside", "smallest angle in the core",
        "under 5 degrees", "AMIPS mean", "same volume exactly", "s, core", "s, all"]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("command", type=pathlib.Path)
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("page", type=pathlib.Path)
    parser.add_argument("--meshes", nargs="+", default=MESHES)
    parser.add_argument("--options", nargs="+", default=OPTIONS)
    given = parser.parse_args()
    lines = []
    for options in given.options:
        rows = []
        for name in given.meshes:
            for program in PROGRAMS:
                with tempfile.TemporaryDirectory() as folder:
                    cells = rows_of(given.command.resolve(), given.folder / f"{name}.obj", options, program,
                                    pathlib.Path(folder))
                rows.append([name, program, *cells, *[""] * (len(HEAD) - 2 - len(cells))])
                print(*rows[-1], flush=True)
        lines += [f"`vdb_shell build {options}`", "", *table(HEAD, rows), ""]
        # After each part, as all of them take minutes.
        replace_tables(given.page, lines)


if __name__ == "__main__":
    main()
