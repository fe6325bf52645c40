#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Holds the moves of vertices along a surface (docs/scripts/paper_moved.py) to their geometry, and the judging meshes to the lists.

    paper_moved_test.py SCRIPTS
"""
import math
import pathlib
import sys
import tempfile

sys.path.insert(0, sys.argv[1])
from paper_halves import JUDGING, half_of  # noqa: E402
from paper_moved import moved, normals_and_heights, write_moved  # noqa: E402
from triangles import cross, dot, minus, read_obj, welded  # noqa: E402

SIZE, SHARE = 6, 0.4


def tilted(x, y):
    """A point of the plane through the origin with normal (-1, -2, 1)."""
    return (x, y, x + 2 * y)


def area_vector(points, triangle):
    a, b, c = (points[v] for v in triangle)
    return cross(minus(b, a), minus(c, a))


points = [tilted(x, y) for y in range(SIZE) for x in range(SIZE)]
triangles = []
for y in range(SIZE - 1):
    for x in range(SIZE - 1):
        a = y * SIZE + x
        triangles += [(a, a + 1, a + SIZE + 1), (a, a + SIZE + 1, a + SIZE)]

normals, heights = normals_and_heights(points, triangles)
for n, height in zip(normals, heights):
    assert math.isclose(-n[0], n[2]) and math.isclose(-n[1], 2 * n[2]) and n[2] > 0, "the normal is the plane's"
    # Sides sqrt 2, sqrt 5 and sqrt 11: twice the area, sqrt 6, over the longest.
    assert math.isclose(height, math.sqrt(6 / 11)), height

for seed in range(20):
    after = moved(points, triangles, SHARE, seed)
    assert after == moved(points, triangles, SHARE, seed), "the same seed, the same surface"
    assert after != moved(points, triangles, SHARE, seed + 100)
    for p, q, height in zip(points, after, heights):
        assert abs(q[2] - q[0] - 2 * q[1]) < 1e-12, "a flat piece stays flat"
        assert 0 < math.dist(p, q) <= SHARE * height * (1 + 1e-12), "no farther than the share of the least height"
    for triangle in triangles:
        assert dot(area_vector(points, triangle), area_vector(after, triangle)) > 0, "no triangle turns over"

with tempfile.TemporaryDirectory() as folder:
    source, target = pathlib.Path(folder) / "source.obj", pathlib.Path(folder) / "target.obj"
    # A quad and a triangle that name the positions of their common edge twice, with texture coordinates and indices from the end.
    source.write_text("v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nf 1/1 2/1 3/1 4/1\nv 1 0 0\nv 2 0 0\nv 1 1 0\nf -3 -2 -1\n")
    found, faces = welded(*read_obj(source))
    assert len(found) == 5 and faces == [(0, 1, 2), (0, 2, 3), (1, 4, 2)], (found, faces)
    write_moved(source, target, SHARE, 1)
    again, same = read_obj(target)
    assert same == faces and again == moved(found, faces, SHARE, 1), "written digits are read back"

assert all(half_of(name) == "judging" for name in JUDGING), "no list has a judging mesh as tuned"
assert half_of("artist/fandisk") == "tuned", "one list that tuned with a mesh is enough"
assert half_of("paper/teapot") == "tuned" and half_of("judging/nobody") == "not listed"
print("moves and halves hold")
