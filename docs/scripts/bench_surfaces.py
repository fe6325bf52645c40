#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Writes a surface for each of the commands that benchmarks.py compares.

    bench_surfaces.py SOURCE.obj PARTS FOLDER

FOLDER gets surface.obj, surface.off, surface.stl and surface.geo. Equal positions are welded, and each edge is cut into
PARTS equal parts, so each triangle becomes PARTS * PARTS in its own plane (up to rounding). Prints the number of
triangles. A process of its own: what it holds would count as memory of the commands that benchmarks.py starts.
"""
import array
import pathlib
import struct
import sys

from triangles import read_obj

GEO = 'Merge "surface.stl";\nCreateTopology;\nSurface Loop(1) = Surface{:};\nVolume(1) = {1};\n'


def welded(points, triangles):
    """In single precision, as every reader but tetgen's has it: all commands get the same surface."""
    places, order = {}, []
    for point in points:
        order.append(places.setdefault(tuple(array.array("f", point)), len(places)))
    return list(places), [tuple(order[corner] for corner in triangle) for triangle in triangles]


def between(a, b, share):
    return tuple(x + (y - x) * share for x, y in zip(a, b))


class Cut:
    """The points of a surface whose edges are cut into equal parts."""

    def __init__(self, points, parts):
        self.points, self.parts, self.rims = list(points), parts, {}

    def add(self, point):
        self.points.append(point)
        return len(self.points) - 1

    def edge(self, a, b):
        """Its points from a to b, made once for both triangles."""
        low, high = min(a, b), max(a, b)
        if (low, high) not in self.rims:
            inner = [self.add(between(self.points[low], self.points[high], k / self.parts))
                     for k in range(1, self.parts)]
            self.rims[low, high] = [low, *inner, high]
        rim = self.rims[low, high]
        return rim if a == low else rim[::-1]

    def rows(self, a, b, c):
        """Row k runs from the k-th point of the edge ab to that of ac and has k + 1 points."""
        left, right, last = self.edge(a, b), self.edge(a, c), self.edge(b, c)
        rows = [[a]]
        for k in range(1, self.parts):
            inner = [self.add(between(self.points[left[k]], self.points[right[k]], i / k)) for i in range(1, k)]
            rows.append([left[k], *inner, right[k]])
        return [*rows, last]


def cut(points, triangles, parts):
    surface, finer = Cut(points, parts), []
    for a, b, c in triangles if parts > 1 else []:
        rows = surface.rows(a, b, c)
        for above, below in zip(rows, rows[1:]):
            finer += [(above[i], below[i], below[i + 1]) for i in range(len(above))]
            finer += [(above[i], below[i + 1], above[i + 1]) for i in range(len(above) - 1)]
    return surface.points, finer if parts > 1 else triangles


def write_lines(path, lines):
    with path.open("w") as stream:
        stream.writelines(lines)


def write_all(folder, points, triangles):
    points = [tuple(array.array("f", point)) for point in points]
    write_lines(folder / "surface.obj", ["v %.9g %.9g %.9g\n" % p for p in points] +
                ["f %d %d %d\n" % (a + 1, b + 1, c + 1) for a, b, c in triangles])
    write_lines(folder / "surface.off", [f"OFF\n{len(points)} {len(triangles)} 0\n"] +
                ["%.9g %.9g %.9g\n" % p for p in points] + ["3 %d %d %d\n" % t for t in triangles])
    with (folder / "surface.stl").open("wb") as stream:
        stream.write(struct.pack("<80xI", len(triangles)))
        for a, b, c in triangles:
            stream.write(struct.pack("<12fH", 0, 0, 0, *points[a], *points[b], *points[c], 0))
    (folder / "surface.geo").write_text(GEO)


def main():
    source, parts, folder = pathlib.Path(sys.argv[1]), int(sys.argv[2]), pathlib.Path(sys.argv[3])
    points, triangles = cut(*welded(*read_obj(source)), parts)
    write_all(folder, points, triangles)
    print(len(triangles))


if __name__ == "__main__":
    main()
