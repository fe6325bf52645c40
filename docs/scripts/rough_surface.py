#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""A real surface of millions of triangles of which no two are flat beside each other, for size_figures.py.

    rough_surface.py SOURCE.obj PARTS OUT.ply [--roughness SHARE]

Each edge is cut into PARTS equal parts, so each triangle becomes PARTS * PARTS. Then each vertex goes along the mean
normal there by a random number between -1 and 1, times SHARE (0.2) of the least height of the small triangles around
it: the noise of a scanner. Two sheets are much farther from each other than that in a scan that does not cross itself,
so the result does not either. Binary PLY. Prints the number of triangles. Needs numpy.
"""
import argparse
import pathlib

import numpy

from robustness import read_obj

SEED = 1


def lattice(parts):
    """Barycentric coordinates (in parts) of the points of a cut triangle, and its small triangles."""
    points = [(parts - i - j, i, j) for i in range(parts + 1) for j in range(parts + 1 - i)]
    place = {point[1:]: at for at, point in enumerate(points)}
    triangles = []
    for i in range(parts):
        for j in range(parts - i):
            triangles.append((place[i, j], place[i + 1, j], place[i, j + 1]))
            if i + j + 2 <= parts:
                triangles.append((place[i + 1, j], place[i + 1, j + 1], place[i, j + 1]))
    return numpy.array(points), numpy.array(triangles)


def place_on_edges(table, triangles, bary, parts, first):
    """Numbers the points inside edges, the same from both sides; gives back how many there are."""
    corners = numpy.stack([triangles, numpy.roll(triangles, -1, axis=1)], axis=2).reshape(-1, 2)
    edges, which = numpy.unique(numpy.sort(corners, axis=1), axis=0, return_inverse=True)
    which = which.reshape(-1, 3)
    for k in range(3):
        on = numpy.flatnonzero((bary[:, (k + 2) % 3] == 0) & (bary[:, k] > 0) & (bary[:, (k + 1) % 3] > 0))
        for at in on:
            forward = triangles[:, k] < triangles[:, (k + 1) % 3]
            step = numpy.where(forward, bary[at, (k + 1) % 3], bary[at, k])
            table[:, at] = first + which[:, k] * (parts - 1) + step - 1
    return len(edges) * (parts - 1)


def cut(points, triangles, parts):
    """The points and triangles of the cut surface."""
    bary, small = lattice(parts)
    table = numpy.empty((len(triangles), len(bary)), numpy.int64)
    for k in range(3):
        table[:, numpy.flatnonzero(bary[:, k] == parts)[0]] = triangles[:, k]
    count = len(points) + place_on_edges(table, triangles, bary, parts, len(points))
    inside = numpy.flatnonzero((bary > 0).all(axis=1))
    table[:, inside] = count + numpy.arange(len(triangles) * len(inside)).reshape(len(triangles), -1)
    finer = numpy.empty((count + table[:, inside].size, 3))
    for at, weights in enumerate(bary):
        finer[table[:, at]] = numpy.einsum("k,fkx->fx", weights / parts, points[triangles])
    finer[:len(points)] = points
    return finer, table[:, small].reshape(-1, 3)


def roughen(points, triangles, share):
    corner = points[triangles]
    across = numpy.cross(corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0])
    squared = [((corner[:, k] - corner[:, k - 1])**2).sum(axis=1) for k in range(3)]
    height = numpy.linalg.norm(across, axis=1) / numpy.sqrt(numpy.max(squared, axis=0))
    least, normal = numpy.full(len(points), numpy.inf), numpy.zeros((len(points), 3))
    for k in range(3):
        numpy.minimum.at(least, triangles[:, k], height)
        for axis in range(3):
            normal[:, axis] += numpy.bincount(triangles[:, k], across[:, axis], len(points))
    normal /= numpy.maximum(numpy.linalg.norm(normal, axis=1), 1e-300)[:, None]
    by = share * least * numpy.random.default_rng(SEED).uniform(-1, 1, len(points))
    return points + normal * by[:, None]


def write_ply(path, points, triangles):
    head = ["ply", "format binary_little_endian 1.0", f"element vertex {len(points)}",
            *(f"property float {axis}" for axis in "xyz"), f"element face {len(triangles)}",
            "property list uchar int vertex_indices", "end_header"]
    faces = numpy.empty(len(triangles), [("count", "u1"), ("corner", "<i4", 3)])
    faces["count"], faces["corner"] = 3, triangles
    with path.open("wb") as stream:
        stream.write(("\n".join(head) + "\n").encode())
        points.astype("<f4").tofile(stream)
        faces.tofile(stream)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("source", type=pathlib.Path)
    parser.add_argument("parts", type=int)
    parser.add_argument("out", type=pathlib.Path)
    parser.add_argument("--roughness", type=float, default=0.2)
    options = parser.parse_args()
    points, triangles = map(numpy.array, read_obj(options.source))
    points, triangles = cut(points, triangles, options.parts)
    write_ply(options.out, roughen(points, triangles, options.roughness), triangles)
    print(len(triangles))


if __name__ == "__main__":
    main()
