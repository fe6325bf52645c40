# SPDX-License-Identifier: Apache-2.0
"""Triangles of an .obj and products of vectors, in Python without any packages. Shares no code with the library."""
import pathlib


def read_obj(path):
    """Points and triangles as they stand there; polygons become fans."""
    points, triangles = [], []
    for words in (line.split() for line in pathlib.Path(path).read_text(errors="replace").splitlines()):
        if words[:1] == ["v"]:
            points.append(tuple(float(word) for word in words[1:4]))
        elif words[:1] == ["f"]:
            corners = [int(word.split("/")[0]) for word in words[1:]]
            corners = [c - 1 if c > 0 else c + len(points) for c in corners]
            triangles += [(corners[0], b, c) for b, c in zip(corners[1:], corners[2:])]
    return points, triangles


def welded(points, triangles):
    """Equal positions are one point, in the order of the first of each."""
    index = {p: i for i, p in enumerate(dict.fromkeys(points))}
    return list(index), [tuple(index[points[v]] for v in t) for t in triangles]


def minus(a, b):
    return tuple(x - y for x, y in zip(a, b))


def cross(a, b):
    return a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))
