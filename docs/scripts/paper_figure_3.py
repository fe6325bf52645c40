# SPDX-License-Identifier: Apache-2.0
"""The paper's figure 3: void and overlap where a curved medial sheet is met by few vertices. A bent, flattened ball whose vertices lie
on the exact surface, from 18 to 4,098 of them. Called by paper.py."""
import math

import charts
from paper_runs import build, figures, with_tables

LEVELS = [1, 2, 3, 4, 5]
WAYS = {"raw": ["--method", "raw"], "relative": ["--method", "raw", "--stop-test", "relative-normal"],
        "lines": ["--no-free-moves"], "free": []}
WORDS = {"raw": "raw, normal test", "relative": "raw, relative test", "lines": "certified, on their lines",
         "free": "certified, free inner vertices"}
FLAGS = ["--resolution", "256", "--samples", "100000"]
PICTURED = 2  # the level of the two sections
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
