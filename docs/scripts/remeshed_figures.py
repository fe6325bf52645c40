#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Measures tapered shells of remeshed surfaces beside TetGen at the same size of elements, by the code of
shape_figures.py, and writes the tables of docs/measurements/remeshed.md. Needs numpy.

    remeshed_figures.py COMMAND MESH_FOLDER docs/measurements/remeshed.md [--ours NAME="OPTIONS" ...] [--only NAME ...]

Every surface is remeshed to its own mean edge length L, or what a row of --ours says instead, where {half} is L / 2.
The command is given the original mesh with --remesh-edge-length; the surface that it made is read from a .usda that it
writes besides. TetGen is given the surface of the first row (-pq1.414/14, which may cut it further, and -pYq1.414/14,
which may not), and the original surface with tets no larger than the regular one of edge L. Fill and tets for each
triangle are of the surface that was given. Meshes go by size, smallest first, until --budget seconds are over. Beside
the page stands the same as JSON; runs are kept in --cache.
"""
import argparse
import json
import pathlib
import re
import shlex
import time

import numpy as np

from halves import HALVES, read_halves
from runs import replace_tables, table
from shape_figures import COLUMNS
from tet_files import read_obj, read_tets
import tet_makers
from tet_makers import TETGEN, Failed, Maker
from tet_shapes import shape_figures

REMESHED = {"TetGen -pq1.414/14": ["-pq1.414/14"], "TetGen -pYq1.414/14": ["-pYq1.414/14"]}
ORIGINAL = "TetGen -pq1.414/14a of the original"
SIZES = [("tets", "tets", "{:.0f}"), *COLUMNS]


def arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("command", type=pathlib.Path)
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("page", type=pathlib.Path)
    tet_makers.add_arguments(parser, ["simulation=--for simulation"], 300)
    parser.add_argument("--budget", type=float, default=3600, help="seconds after which no mesh is begun")
    return parser.parse_args()


def mean_edge(points, triangles):
    ends = np.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]])
    return float(np.linalg.norm(points[ends[:, 0]] - points[ends[:, 1]], axis=1).mean())


def surface_of_usda(path):
    """Points and triangles of the prim "surface"."""
    text = path.read_text()
    text = text[text.index('def Mesh "surface"'):text.index('def TetMesh "tets"')]
    corners = re.search(r"int\[\] faceVertexIndices = \[([^\]]*)\]", text)[1]
    points = re.search(r"point3f\[\] points = \[([^\]]*)\]", text)[1]
    return (np.array(re.findall(r"[-+.\deE]+", points), float).reshape(-1, 3),
            np.array(corners.split(","), np.int64).reshape(-1, 3))


def write_obj(path, points, triangles):
    lines = ["v " + " ".join(repr(float(x)) for x in p) for p in points]
    lines += ["f " + " ".join(str(c + 1) for c in t) for t in triangles.tolist()]
    path.write_text("\n".join(lines) + "\n")


def figures(tets, surface):
    try:
        return shape_figures(*read_tets(tets()), *surface)
    except (Failed, ValueError) as error:
        return {"failed": str(error)}


def measure(options, maker, ours, mesh):
    """{way: figures}"""
    original = read_obj(mesh)
    length = mean_edge(*original)
    runs, remeshed = {}, None
    for way, words in ours.items():
        words = [word.replace("{half}", repr(length / 2)) for word in words]
        if "--remesh-edge-length" not in words:
            words += ["--remesh-edge-length", repr(length)]
        try:
            tets = maker.ours(mesh, [*words, "-o", "surface.usda"])[0]
        except Failed as error:
            runs[way] = {"failed": str(error)}
            continue
        path = tets.parent / f"{mesh.stem}.obj"
        if not path.exists():
            write_obj(path, *surface_of_usda(tets.parent / "surface.usda"))
        remeshed = remeshed or path
        runs[way] = figures(lambda: tets, read_obj(path))
    if remeshed is None:
        return runs
    for way, words in REMESHED.items():
        TETGEN[way] = words
        runs[way] = figures(lambda: maker.others(remeshed, way), read_obj(remeshed))
    sized = f"-pq1.414/14a{length ** 3 / (6 * 2 ** .5):.12f}"
    TETGEN[f"TetGen {sized}"] = [sized]
    runs[ORIGINAL] = figures(lambda: maker.others(mesh, f"TetGen {sized}"), original)
    return runs


def cells(found):
    if "failed" in found:
        return ["failed: " + found["failed"]] + [""] * (len(SIZES) - 1)
    return [form.format(found[key]) for _, key, form in SIZES]


def mean_row(rows):
    mean = {key: sum(row[key] for row in rows) / len(rows) for _, key, _ in SIZES}
    mean["tets"] = float(np.exp(np.mean(np.log([row["tets"] for row in rows]))))
    return cells(mean | {"amips_worst": max(row["amips_worst"] for row in rows),
                         "smallest_degrees": min(row["smallest_degrees"] for row in rows),
                         "not_positive": sum(row["not_positive"] for row in rows)})


def write_page(options, runs, halves):
    ways = list(dict.fromkeys(way for found in runs.values() for way in found))
    common = [name for name in runs if all(way in runs[name] and "failed" not in runs[name][way] for way in ways)]
    head = [head for head, _, _ in SIZES]
    rows = []
    for way in ways:
        for part in ("all", *HALVES):
            names = [name for name in common if part in ("all", halves[name])]
            if names:
                rows.append([way, part, str(len(names)), *mean_row([runs[name][way] for name in names])])
    left_out = [name for name in halves if name not in runs]
    failed = sorted(set(runs) - set(common))
    lines = ["### Means", "", f"Of {len(common)} meshes"
             + (f"; not measured for want of time: {', '.join(left_out)}" if left_out else "")
             + (f"; without {', '.join(failed)}, of which not every way made tets" if failed else "") + ".", "",
             *table(["way", "half", "meshes", *head], rows), "", "### Each mesh", "",
             *table(["mesh", "half", "way", "triangles", *head],
                    [[name, halves[name], way, str(runs[name][way].get("triangles", "")), *cells(runs[name][way])]
                     for name in runs for way in ways if way in runs[name]])]
    if not options.page.exists():
        options.page.write_text("<!-- tables: begin -->\n<!-- tables: end -->\n")
    replace_tables(options.page, lines)
    found = [{"mesh": name, "half": halves[name], "way": way, **one}
             for name in runs for way, one in runs[name].items()]
    options.page.with_suffix(".json").write_text("[\n" + ",\n".join(map(json.dumps, found)) + "\n]\n")


def main():
    options = arguments()
    halves = read_halves(options.meshes)
    ours = {name: shlex.split(words) for name, words in (one.split("=", 1) for one in options.ours)}
    maker, runs = Maker(options.command.resolve(), options.cache, options.seconds), {}
    names = [name for name in halves if not options.only or name in options.only]
    paths = {name: (options.folder / f"{name}.obj").resolve() for name in names}
    begin = time.monotonic()
    for name in sorted(names, key=lambda name: paths[name].stat().st_size):
        if time.monotonic() - begin > options.budget:
            break
        runs[name] = measure(options, maker, ours, paths[name])
        for way, found in runs[name].items():
            print(f"{name}, {way}: {' '.join(cells(found))}", flush=True)
        write_page(options, runs, halves)


if __name__ == "__main__":
    main()
