#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Measures the stop tests on the situations of the paper's figure 2; writes the tables and the picture of the page.

    symmetry_lines.py COMMAND MESH_FOLDER docs/measurements/symmetry_lines.md docs/measurements/images/symmetry_lines.svg

COMMAND is the vdb_shell binary. The shapes are made by symmetry_shapes.py.
"""
import json
import math
import pathlib
import subprocess
import sys
import tempfile

from runs import replace_tables, table
from symmetry_shapes import SITUATIONS, write_obj

TESTS = [("normal", ["--stop-test", "normal"]), ("normal, rho 0", ["--stop-test", "normal", "--rho", "0"]),
         ("relative-normal", ["--stop-test", "relative-normal"]), ("own-sheet", ["--stop-test", "own-sheet"])]
MESHES = ["paper/box", "paper/teapot", "paper/cow", "paper/bunny_low_resolution", "paper/propella", "paper/funnel", "paper/bend"]
RESOLUTION = 256
NOT_VALID = 7  # what `build` ends with when it has written a shell that overlaps or has inverted tets


def run(command, mesh, folder, flags):
    """Pillars by vertex and the report."""
    node, report = folder / "shell.node", folder / "report.json"
    done = subprocess.run([command, "build", "-q", str(mesh), "--resolution", str(RESOLUTION), "-o", str(node), "--report",
                           str(report), *flags], stderr=subprocess.PIPE, text=True)
    if "the shell has no tet" in done.stderr:
        return {}, None
    if done.returncode not in (0, NOT_VALID):
        raise RuntimeError(done.stderr)
    ends = {}
    for line in node.read_text().splitlines()[2:]:
        cells = line.split()
        ends.setdefault(int(cells[4]), []).append([float(c) for c in cells[1:4]])
    lengths = {vertex: math.dist(pair[0], pair[-1]) for vertex, pair in ends.items()}
    return lengths, json.loads(report.read_text())


def measure(command, situation, folder):
    mesh = folder / "solid.obj"
    write_obj(mesh, situation)
    vertex = situation.watched_vertex()
    lengths = {}
    for name, flags in TESTS:
        found, report = run(command, mesh, folder, ["--method", "raw", "--samples", "0", *flags])
        lengths[name] = found.get(vertex, 0.0)  # a vertex without tets is not written: pinned
    grown, report = run(command, mesh, folder, ["--samples", "100000"])
    return {"lengths": lengths, "voxel": report["field"]["voxel_size"], "grown": grown[vertex], "fill": report["volume"]["fill"],
            "certified": report["certificate"]["certified"], "several": report["coverage"]["in_several"]}


def across(situation, length, voxel):
    """How far beyond the sheet, square to it, in voxels; negative: before it."""
    return (length - situation.wanted) * math.sin(situation.sheet_angle) / voxel


def situation_tables(results):
    head = ["figure", "situation", "wanted", "analytic, rho 0.9", "analytic, rho 0"] + [name for name, _ in TESTS] + \
           ["own-sheet: voxels across the sheet"]
    rows, grown = [], []
    for s, r in results:
        rows.append([s.figure, s.name, f"{s.wanted:.3f}", f"{s.exact_end(0.9):.3f}", f"{s.exact_end(0):.3f}"] +
                    [f"{r['lengths'][name]:.3f}" for name, _ in TESTS] +
                    [f"{across(s, r['lengths']['own-sheet'], r['voxel']):+.1f}"])
        grown.append([s.figure, s.name, "yes" if r["certified"] else "**no**", f"{r['grown']:.3f}", f"{s.wanted:.3f}",
                      f"{r['fill']:.3f}", str(r["several"])])
    return table(head, rows), table(["figure", "situation", "certified", "pillar at the watched vertex", "own-sheet's aim", "fill",
                                     "points in two tets, of 100000"], grown)


def mesh_table(command, root, folder):
    head = ["mesh"] + [f"{name}: {what}" for name, _ in TESTS for what in ("fill", "inverted", "covered twice %")]
    rows = []
    for name in MESHES:
        row = [name]
        for _, flags in TESTS:
            _, report = run(command, root / f"{name}.obj", folder, ["--method", "raw", "--samples", "100000", *flags])
            row += [f"{report['volume']['fill']:.3f}", str(report["tets"]["inverted"]),
                    f"{100 * report['coverage']['overlap_share']:.2f}"] if report else ["0.000", "0", "0.00"]
        rows.append(row)
    return table(head, rows)


def draw(results, path):
    """One drawing a situation: the section, its symmetry sheet by steps, and where the tests end."""
    shown = [results[0], results[2], results[3], results[5]]
    size, gap, parts = 230, 24, []
    colours = {"normal": "#c03030", "normal, rho 0": "#d08a20", "own-sheet": "#207040"}
    for column, (s, r) in enumerate(shown):
        xs, ys = zip(*s.polygon)
        scale = size / max(max(xs) - min(xs), max(ys) - min(ys))
        left = gap + column * (size + gap)

        def at(p):
            return (left + size / 2 + scale * (p[0] - (max(xs) + min(xs)) / 2), 40 + size - scale * (p[1] - min(ys)))
        corners = " ".join("%.1f,%.1f" % at(p) for p in s.polygon)
        parts.append(f'<polygon points="{corners}" fill="#eef3f8" stroke="#303848" stroke-width="1.5"/>')
        for q in sheet_points(s):
            parts.append('<circle cx="%.1f" cy="%.1f" r="0.7" fill="#8090b0"/>' % at(q))
        p, d = s.polygon[s.watched], s.direction()
        for name, colour in colours.items():
            shift = {"normal": -3, "normal, rho 0": 3, "own-sheet": 0}[name]
            length = r["lengths"][name]
            (x0, y0), (x1, y1) = at(p), at((p[0] + length * d[0], p[1] + length * d[1]))
            parts.append(f'<line x1="{x0 + shift:.1f}" y1="{y0:.1f}" x2="{x1 + shift:.1f}" y2="{y1:.1f}" stroke="{colour}" stroke-width="2"/>')
            parts.append(f'<circle cx="{x1 + shift:.1f}" cy="{y1:.1f}" r="3" fill="{colour}"/>')
        x, y = at((p[0] + s.wanted * d[0], p[1] + s.wanted * d[1]))
        parts.append(f'<circle cx="{x:.1f}" cy="{y:.1f}" r="6" fill="none" stroke="#202020"/>')
        parts.append(f'<text x="{left}" y="24" font-size="13">({s.figure[1]}) {s.name}</text>')
    height, width = size + 80, gap + len(shown) * (size + gap)
    for i, (name, colour) in enumerate(colours.items()):
        parts.append(f'<text x="{gap + 150 * i}" y="{height - 10}" font-size="13" fill="{colour}">{name}</text>')
    parts.append(f'<text x="{gap + 450}" y="{height - 10}" font-size="13" fill="#202020">ring: where it ought to end; dots: the symmetry sheets</text>')
    path.write_text(f'<svg xmlns="http://www.w3.org/2000/svg" width="{width}" height="{height}" font-family="sans-serif">\n'
                    f'<rect width="{width}" height="{height}" fill="white"/>\n' + "\n".join(parts) + "\n</svg>\n")


def sheet_points(s, count=90):
    """Points of a lattice next to which two sides are as near as each other."""
    xs, ys = zip(*s.polygon)
    sides = s.normals()
    cell = max(max(xs) - min(xs), max(ys) - min(ys)) / count
    for i in range(count + 1):
        for j in range(count + 1):
            q = (min(xs) + i * cell, min(ys) + j * cell)
            depths = sorted(((n[0] * q[0] + n[1] * q[1] - c, n) for n, c in sides), key=lambda side: side[0])
            apart = math.dist(depths[0][1], depths[1][1])
            if depths[0][0] > 0 and 1e-9 < apart and depths[1][0] - depths[0][0] < 0.5 * apart * cell:
                yield q


def main():
    command, root = sys.argv[1], pathlib.Path(sys.argv[2])
    page, picture = pathlib.Path(sys.argv[3]), pathlib.Path(sys.argv[4])
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        results = [(s, measure(command, s, folder)) for s in SITUATIONS]
        draw(results, picture)
        lines, grown = situation_tables(results)
        meshes = mesh_table(command, root, folder)
    replace_tables(page, ["### Lengths", "", *lines, "", "### Growth on the same solids", "", *grown, "", "### Raw shells of real meshes", "",
                          *meshes])


if __name__ == "__main__":
    main()
