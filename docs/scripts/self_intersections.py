#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Shells of surfaces that cross themselves, for docs/measurements/self_intersections.md.

    self_intersections.py COMMAND MESH_FOLDER docs/measurements/self_intersections.md

The two boxes and the tube are made here. Each build is one run on one thread.
"""
import math
import pathlib
import tempfile

from runs import arguments, build, replace_tables, table

NOT_VALID = 7  # what `build` ends with when it has written a shell that is not valid
COMMON = ["--allow-self-intersections", "--turn-outward"]


def gridded_box(low, high, cells):
    """Faces in cells x cells squares, cut in two; points come once."""
    points, triangles = {}, []
    for axis in range(3):
        u, v = (axis + 1) % 3, (axis + 2) % 3
        for end in (0, cells):
            for i in range(cells):
                for j in range(cells):
                    corners = []
                    for di, dj in ((0, 0), (1, 0), (1, 1), (0, 1)):
                        at = [0, 0, 0]
                        at[axis], at[u], at[v] = end, i + di, j + dj
                        corners.append(points.setdefault(tuple(at), len(points)))
                    a, b, c, d = corners if end else corners[::-1]
                    triangles += [(a, b, c), (a, c, d)]
    return [[lo + (hi - lo) * k / cells for lo, hi, k in zip(low, high, at)] for at in points], triangles


def crossing_boxes():
    points, triangles = gridded_box((0, 0, 0), (1, 1, 1), 8)
    more, others = gridded_box((0.55, 0.55, 0.55), (1.45, 1.45, 1.45), 8)
    return points + more, triangles + [tuple(v + len(points) for v in t) for t in others]


def tube_of_eight(around=68, across=16, radius=0.15):
    """Along a figure of eight in a plane, so that it runs through itself where its two strands meet."""
    points, triangles = [], []
    for i in range(around):
        # Half a step on, so that no ring of points lies just where the strands cross.
        t = 2 * math.pi * (i + 0.5) / around
        x, y, dx, dy = math.sin(t), math.sin(2 * t) / 2, math.cos(t), math.cos(2 * t)
        length = math.hypot(dx, dy)
        for j in range(across):
            a = 2 * math.pi * j / across
            side, up = radius * math.cos(a), radius * math.sin(a)
            points.append([x + side * dy / length, y - side * dx / length, up])
            here, ahead = i * across, (i + 1) % around * across
            k = (j + 1) % across
            triangles += [(here + j, ahead + j, ahead + k), (here + j, ahead + k, here + k)]
    return points, triangles


def write_obj(path, mesh):
    points, triangles = mesh
    path.write_text("".join("v {!r} {!r} {!r}\n".format(*map(float, p)) for p in points) +
                    "".join(f"f {a + 1} {b + 1} {c + 1}\n" for a, b, c in triangles))
    return path


def figures(report):
    mesh, overlaps, prisms = report["mesh"], report["overlaps"], report["prisms"]
    return {"triangles": mesh["triangles"], "crossings": mesh["self_intersections"], "copies": mesh["vertex_copies"],
            "pinned": prisms["pinned_vertices"], "pairs": overlaps["pairs"]["count"],
            "prisms": overlaps["prisms"], "certified": overlaps["certified_prisms"], "fill": report["volume"]["fill"]}


def main():
    a = arguments(__doc__)
    rows = []
    with tempfile.TemporaryDirectory() as scratch:
        folder = pathlib.Path(scratch)
        surfaces = [("artist/cow", a.folder / "artist/cow.obj", ["--resolution", "128"]),
                    ("two boxes that cross by a corner", write_obj(folder / "boxes.obj", crossing_boxes()), ["--resolution", "96"]),
                    ("a tube along a figure of eight", write_obj(folder / "eight.obj", tube_of_eight()), ["--resolution", "96"])]
        for name, mesh, more in surfaces:
            done = build(a.command, mesh, [*COMMON, *more], figures)
            if done["exit"] != 0:
                raise SystemExit(f"{name}: {done}")
            other = build(a.command, mesh, [*COMMON, *more, "--method", "raw"], figures, (0, NOT_VALID))
            rows.append([name, f"{done['triangles']:,}", str(done["copies"]), str(done["crossings"]), str(done["pinned"]),
                         str(done["pairs"]), f"{done['certified']} of {done['prisms']}", f"{done['fill']:.3f}",
                         f"{other['pairs']}, {other['certified']} of {other['prisms']}"])
    head = ["surface", "triangles", "points copied", "crossing pairs", "pinned", "pairs of tets that overlap",
            "prisms certified, of those with tets", "fill", "raw: pairs, prisms certified"]
    replace_tables(a.page, table(head, rows))


if __name__ == "__main__":
    main()
