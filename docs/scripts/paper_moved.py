# SPDX-License-Identifier: Apache-2.0
"""Surfaces whose vertices are moved along the surface at random: the "initial slight tangential perturbation of the surface mesh
vertices" of the paper's section 2. Called by the parts of paper.py."""
import math
import random

from triangles import cross, dot, minus, read_obj, welded


def normals_and_heights(points, triangles):
    """Angle-weighted pseudo-normals, not of unit length, and the least height of the triangles around each point."""
    normals, heights = [[0.0] * 3 for _ in points], [math.inf] * len(points)
    for t in triangles:
        a, b, c = (points[v] for v in t)
        square = cross(minus(b, a), minus(c, a))
        doubled = math.hypot(*square)
        if not doubled:
            continue
        height = doubled / max(math.dist(a, b), math.dist(b, c), math.dist(c, a))
        for k, v in enumerate(t):
            p, q, r = (points[t[(k + i) % 3]] for i in range(3))
            angle = math.atan2(doubled, dot(minus(q, p), minus(r, p)))
            normals[v] = [n + angle * s / doubled for n, s in zip(normals[v], square)]
            heights[v] = min(heights[v], height)
    return normals, heights


def moved(points, triangles, share, seed):
    """Each point goes in a random direction of its tangent plane, as far as a random share, of at most `share`, of the least height of
    its triangles: below a half no triangle of a flat piece turns over, whatever its neighbours do. Only used points are moved."""
    source = random.Random(seed)
    normals, heights = normals_and_heights(points, triangles)
    answer = []
    for p, n, height in zip(points, normals, heights):
        length, angle, reach = math.hypot(*n), source.uniform(0, 2 * math.pi), share * source.random()
        if not length or height == math.inf:
            answer.append(p)
            continue
        n = [x / length for x in n]
        least = min(range(3), key=lambda axis: abs(n[axis]))
        u = cross(n, [float(axis == least) for axis in range(3)])
        size = math.hypot(*u)
        u = [x / size for x in u]
        v = cross(n, u)
        answer.append(tuple(x + reach * height * (math.cos(angle) * s + math.sin(angle) * t) for x, s, t in zip(p, u, v)))
    return answer


def write_moved(source, path, share, seed):
    points, triangles = welded(*read_obj(source))
    lines = ["v %.17g %.17g %.17g" % tuple(p) for p in moved(points, triangles, share, seed)]
    path.write_text("\n".join(lines + ["f %d %d %d" % tuple(v + 1 for v in t) for t in triangles]) + "\n")
    return path
