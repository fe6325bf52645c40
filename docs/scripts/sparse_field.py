# SPDX-License-Identifier: Apache-2.0
"""Measures the sparse field against the dense one: python3 docs/scripts/sparse_field.py COMMAND FOLDER_OF_MESHES PAGE

Runs `build --method raw` with --field dense and --field sparse, and `build` as it is, in turn, several times each, and
puts the table into the page. Lengths are compared vertex by vertex through the inner surfaces of the raw shells, which
have the same lines."""
import json
import math
import pathlib
import statistics
import subprocess
import sys
import tempfile

import runs

STAGES = ["level set", "line stepping"]
HEAD = ["mesh", "vertices", "dense s", "sparse s", "ratio", "dense peak MiB", "sparse peak MiB", "median", "99 %",
        "over 2 voxels", "certified build s", "dense over it"]
ROUTES = {"dense": ["--method", "raw", "--field", "dense"], "sparse": ["--method", "raw", "--field", "sparse"],
          "certified": []}


def inner_points(path):
    with path.open() as stream:
        return [tuple(map(float, line.split()[1:4])) for line in stream if line.startswith("v ")]


def run(command, mesh, route, folder):
    report, inner = folder / f"{route}.json", folder / f"{route}.obj"
    subprocess.run([command, "build", str(mesh), *ROUTES[route], "--samples", "0", "-q", "--report", str(report),
                    "-o", str(inner)], check=True)
    figures = json.loads(report.read_text())
    costs = {cost["stage"]: cost["seconds"] for cost in figures["stages"]}
    peak = next(cost["peak_memory_bytes"] for cost in figures["stages"] if cost["stage"] == "line stepping")
    return sum(costs[stage] for stage in STAGES), peak / 2**20, figures["field"], inner_points(inner)


def row(command, name, folder, repeats):
    mesh = folder / f"{name}.obj"
    with tempfile.TemporaryDirectory() as temporary:
        rounds = [[run(command, mesh, route, pathlib.Path(temporary)) for route in ROUTES] for _ in range(repeats)]
    dense, sparse, _ = rounds[-1]
    voxel = dense[2]["voxel_size"]
    apart = sorted(math.dist(a, b) / voxel for a, b in zip(dense[3], sparse[3]))
    seconds = [statistics.median(one[i][0] for one in rounds) for i in range(3)]
    ratio = [statistics.median(one[0][0] / one[i][0] for one in rounds) for i in (1, 2)]
    return [name.split("/")[1], str(len(apart)), f"{seconds[0]:.3f}", f"{seconds[1]:.3f}", f"{ratio[0]:.1f}",
            f"{dense[1]:.0f}", f"{sparse[1]:.0f}", f"{statistics.median(apart):.2f}",
            f"{apart[int(0.99 * len(apart))]:.1f}", str(sum(a > 2 for a in apart)), f"{seconds[2]:.3f}",
            f"{ratio[1]:.1f}"]


def main():
    arguments = runs.arguments(__doc__)
    meshes = ["paper/sphere", "paper/teapot", "artist/fandisk"] if arguments.quick else runs.CLEAN_MESHES
    rows = [row(arguments.command, name, arguments.folder, 1 if arguments.quick else 5) for name in meshes]
    runs.replace_tables(arguments.page, runs.table(HEAD, rows))


if __name__ == "__main__":
    sys.exit(main())
