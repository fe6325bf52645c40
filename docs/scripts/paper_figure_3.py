# SPDX-License-Identifier: Apache-2.0
"""The paper's figure 3: void and overlap where a curved medial sheet is met by few vertices. A bent, flattened ball whose vertices lie
on the exact surface, from 18 to 4,098 of them. Called by paper.py."""
import math
import subprocess

import charts
from paper_runs import NOT_VALID, build, figures, with_tables

LEVELS = [1, 2, 3, 4, 5]
WAYS = {"raw": ["--method", "raw"], "relative": ["--method", "raw", "--stop-test", "relative-normal"],
        "lines": ["--no-free-moves"], "free": []}
WORDS = {"raw": "raw, normal test", "relative": "raw, relative test", "lines": "certified, on their lines",
         "free": "certified, free inner vertices"}
FLAGS = ["--resolution", "256", "--samples", "100000"]
PICTURED = 2  # the level of the two sections
RIM = 0.2  # |y| of the unit sphere: the medial sheet's rim is below y = 0, and a zone's area is its height, so a fifth of the vertices
HALF_AXES, BEND = (1.0, 0.35, 0.7), 0.45


def ball(level):
    """An octahedron cut `level` times, its vertices on the unit sphere."""
    points = [(1, 0, 0), (-1, 0, 0), (0, 1, 0), (0, -1, 0), (0, 0, 1), (0, 0, -1)]
    triangles = [(a, b, c) for a in (0, 1) for b in (2, 3) for c in (4, 5)]
    triangles = [(a, b, c) if (a + b + c - 6) % 2 == 0 else (a, c, b) for a, b, c in triangles]
    for _ in range(level):
        middles, finer = {}, []

        def middle(a, b):
            key = (min(a, b), max(a, b))
            if key not in middles:
                sums = [points[a][k] + points[b][k] for k in range(3)]
                length = math.hypot(*sums)
                middles[key] = len(points)
                points.append(tuple(s / length for s in sums))
            return middles[key]
        for a, b, c in triangles:
            ab, bc, ca = middle(a, b), middle(b, c), middle(c, a)
            finer += [(a, ab, ca), (b, bc, ab), (c, ca, bc), (ab, bc, ca)]
        triangles = finer
    return points, triangles


def bent(p):
    x, y, z = (h * c for h, c in zip(HALF_AXES, p))
    x, y = x, y + BEND * x * x
    c, s = math.cos(0.3), math.sin(0.3)
    return (c * x - s * y + 0.0031, s * x + c * y + 0.0072, z + 0.0013)


def write_obj(path, level):
    points, triangles = ball(level)
    lines = ["v %.9g %.9g %.9g" % bent(p) for p in points] + ["f %d %d %d" % tuple(v + 1 for v in t) for t in triangles]
    path.write_text("\n".join(lines) + "\n")
    return len(points), len(triangles)


def rows_of(path):
    """Of a TetGen file: without comments and its head."""
    return [line.split() for line in path.read_text().splitlines() if line.strip() and not line.startswith("#")][1:]


def at_the_rim(command, mesh, level):
    """Inverted tets of the raw shell, and how many of them stand on a vertex of the zone whose lines end at the sheet's rim."""
    node = mesh.with_suffix(".node")
    done = subprocess.run([command, "--threads", "1", "build", "-q", str(mesh), "--method", "raw", "--resolution", "256", "--samples", "0",
                           "-o", str(node)], capture_output=True, text=True)
    if done.returncode not in (0, NOT_VALID):
        raise RuntimeError(done.stderr)
    sphere = ball(level)[0]
    corners = {}
    for cells in rows_of(node):
        corners[cells[0]] = ([float(c) for c in cells[1:4]], int(cells[4]))
    inverted, there = 0, 0
    for cells in rows_of(node.with_suffix(".ele")):
        (a, b, c, d), vertices = zip(*(corners[corner] for corner in cells[1:5]))
        u, v, w = ([x - y for x, y in zip(p, a)] for p in (b, c, d))
        volume = sum(u[i] * (v[(i + 1) % 3] * w[(i + 2) % 3] - v[(i + 2) % 3] * w[(i + 1) % 3]) for i in range(3))
        if volume < 0:
            inverted += 1
            there += any(abs(sphere[vertex][1]) < RIM for vertex in vertices)
    near = sum(abs(p[1]) < RIM for p in sphere)
    return {"vertices_percent": 100 * near / len(sphere), "inverted": inverted, "inverted_there": there,
            "inverted_percent": 100 * there / max(1, inverted)}


def make(command, folder, page_folder):
    rows = {}
    for level in LEVELS:
        mesh = folder / f"bent_{level}.obj"
        vertices, triangles = write_obj(mesh, level)
        rows[str(level)] = {"vertices": vertices, "triangles": triangles}
        for way, flags in WAYS.items():
            output = []
            if level == PICTURED and way in ("raw", "free"):
                output = ["-o", str(page_folder / "images" / f"figure_3_{way}.png"), "--picture-width", "420", "--section-axis", "z"]
            rows[str(level)][way] = figures(build(command, mesh, [*flags, *FLAGS, *output])[0])
        rows[str(level)]["rim"] = at_the_rim(command, mesh, level)
    chart = {WORDS[way]: [(row["vertices"], max(1 - row[way]["covered_percent"] / 100, 1e-4)) for row in rows.values()] for way in WAYS}
    charts.log_chart(page_folder / "images" / "figure_3.svg", "Share of the solid that no tet covers", "vertices", "void", chart,
                     [row["vertices"] for row in rows.values()])
    answer = {"levels": rows}
    return with_tables(answer, main=table(answer))


def table(answer):
    head = ["vertices"] + [f"{WORDS[way]}: {what}" for way in WAYS for what in ("covered %", "twice %", "overlapping pairs", "inverted")]
    rows = []
    for row in answer["levels"].values():
        cells = [str(row["vertices"])]
        for way in WAYS:
            cells += [f"{row[way]['covered_percent']:.1f}", f"{row[way]['twice_percent']:.2f}", str(row[way]["overlapping_pairs"]),
                      str(row[way]["inverted"])]
        rows.append(cells)
    return head, rows
