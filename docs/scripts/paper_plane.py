# SPDX-License-Identifier: Apache-2.0
"""Plane shapes of segments and arcs, random points on them, and how far inward a point stays nearest to itself.

Nothing here reads a field: limits come from the shape's own boundary.
"""
import math

import numpy

# The outline of an animal: limbs, notches, long and short sides; counter-clockwise.
OUTLINE = [(0.00, 0.00), (0.22, 0.00), (0.26, 0.28), (0.62, 0.26), (0.66, 0.00), (0.86, 0.02), (0.84, 0.36), (1.00, 0.52),
           (0.90, 0.70), (0.70, 0.56), (0.30, 0.58), (0.18, 0.80), (0.02, 0.72), (0.08, 0.45)]
TURN, SHIFT = 0.31, (0.0137, 0.0071)  # off the axes, and off the voxels
FILLET = 0.08
SAGITTA = 2e-6  # of the polygon that stands for arcs, as a share of the shape's size: 0.002 voxels at 1024


class Segment:
    def __init__(self, a, b):
        self.a, self.b = numpy.array(a), numpy.array(b)
        self.length = math.dist(a, b)
        tangent = (self.b - self.a) / self.length
        self.outward = numpy.array([tangent[1], -tangent[0]])

    def at(self, share):
        """Points and outward normals at shares of the length."""
        share = numpy.asarray(share)[:, None]
        return self.a + share * (self.b - self.a), numpy.repeat(self.outward[None], len(share), 0)

    def pieces(self):
        return 1


class Arc:
    """Tangent to the sides that it rounds; `sign` is 1 where the solid is on the side of the centre."""

    def __init__(self, centre, radius, start, turn):
        self.centre, self.radius, self.start, self.turn = numpy.array(centre), radius, start, turn
        self.length, self.sign = radius * abs(turn), math.copysign(1, turn)

    def at(self, share):
        angle = self.start + numpy.asarray(share) * self.turn
        out = numpy.stack([numpy.cos(angle), numpy.sin(angle)], 1)
        return self.centre + self.radius * out, self.sign * out

    def pieces(self):
        widest = 2 * math.acos(1 - min(1, SAGITTA / self.radius))
        return max(2, math.ceil(abs(self.turn) / widest))


def placed(p):
    c, s = math.cos(TURN), math.sin(TURN)
    return (c * p[0] - s * p[1] + SHIFT[0], s * p[0] + c * p[1] + SHIFT[1])


def cornered():
    corners = [placed(p) for p in OUTLINE]
    return [Segment(a, b) for a, b in zip(corners, corners[1:] + corners[:1])]


def rounded():
    """The same outline with a fillet at each corner, as wide as its sides allow."""
    corners = [numpy.array(placed(p)) for p in OUTLINE]
    ends, arcs = [], []
    for before, corner, after in zip(corners[-1:] + corners[:-1], corners, corners[1:] + corners[:1]):
        u, v = corner - before, after - corner
        a, b = numpy.linalg.norm(u), numpy.linalg.norm(v)
        turn = math.atan2(u[0] * v[1] - u[1] * v[0], u @ v)
        cut = min(FILLET * math.tan(abs(turn) / 2), 0.45 * a, 0.45 * b)
        radius = cut / math.tan(abs(turn) / 2)
        left = numpy.array([-u[1], u[0]]) / a * math.copysign(1, turn)
        centre = corner - cut * u / a + radius * left
        arcs.append(Arc(centre, radius, math.atan2(*(-left)[::-1]), turn))
        ends.append((corner - cut * u / a, corner + cut * v / b))
    shape = []
    for i, arc in enumerate(arcs):
        shape += [arc, Segment(ends[i][1], ends[(i + 1) % len(ends)][0])]
    return shape


def random_points(shape, count, seed):
    """Points uniform in arc length, with the exact outward normals."""
    rng = numpy.random.default_rng(seed)
    stops = numpy.cumsum([piece.length for piece in shape])
    s = rng.random(count) * stops[-1]
    which = numpy.searchsorted(stops, s)
    points, normals = numpy.zeros((count, 2)), numpy.zeros((count, 2))
    for i, piece in enumerate(shape):
        mine = which == i
        if mine.any():
            points[mine], normals[mine] = piece.at((s[mine] - (stops[i] - piece.length)) / piece.length)
    return points, normals


def dense_boundary(shape, count=20000):
    total = sum(piece.length for piece in shape)
    return numpy.concatenate([piece.at(numpy.linspace(0, 1, max(2, round(count * piece.length / total)) + 1))[0]
                              for piece in shape])


def exact_limits(shape, points, normals):
    """The largest e for which p is still a nearest boundary point of p - e n.

    |f - (p - e n)| >= e for a boundary point f is e <= |f - p|^2 / (2 (-n) . (f - p)) where the point lies ahead, so the limit is the
    least of that over the boundary: where the line meets the medial axis. The samples are 20,000; near the least the quotient is
    flat, so their spacing of 2e-4 counts by its square only."""
    boundary = dense_boundary(shape)
    limits = numpy.empty(len(points))
    for i, (p, n) in enumerate(zip(points, normals)):
        ahead = boundary - p
        depth = -(ahead @ n)
        # Nearer than this the quotient is 0 / 0: on p's own side. What is that near and ahead is on p's own arc, and so are
        # its neighbours farther away.
        depth[(ahead * ahead).sum(1) < 1e-7] = 0
        seen = depth > 1e-12
        limits[i] = ((ahead[seen] ** 2).sum(1) / (2 * depth[seen])).min()
    return limits


def crossings(starts, ends):
    """For each segment the number of others that it crosses properly."""
    d = ends - starts

    def side(i):
        return numpy.sign(d[i, 0] * (starts[:, 1] - starts[i, 1]) - d[i, 1] * (starts[:, 0] - starts[i, 0])), \
               numpy.sign(d[i, 0] * (ends[:, 1] - starts[i, 1]) - d[i, 1] * (ends[:, 0] - starts[i, 0]))
    parted = numpy.zeros((len(starts), len(starts)), bool)
    for i in range(len(starts)):
        a, b = side(i)
        parted[i] = a * b < 0
    return (parted & parted.T).sum(1)


def polygon(shape):
    return numpy.concatenate([piece.at(numpy.arange(piece.pieces()) / piece.pieces())[0] for piece in shape])


def cross(o, a, b):
    return (a[..., 0] - o[..., 0]) * (b[..., 1] - o[..., 1]) - (a[..., 1] - o[..., 1]) * (b[..., 0] - o[..., 0])


def ears(corners):
    """Triangles of a simple polygon, by cutting off ears."""
    left, triangles = list(range(len(corners))), []
    i = 0
    while len(left) > 3:
        a, b, c = left[i - 1], left[i % len(left)], left[(i + 1) % len(left)]
        pa, pb, pc = corners[[a, b, c]]
        others = corners[[k for k in left if k not in (a, b, c)]]
        inside = (cross(pa, pb, others) >= 0) & (cross(pb, pc, others) >= 0) & (cross(pc, pa, others) >= 0)
        if cross(pa, pb, pc) > 0 and not inside.any():
            triangles.append((a, b, c))
            del left[i % len(left)]
            i = i % len(left)
        else:
            i = (i + 1) % len(left)
    return triangles + [tuple(left)]


def staircase(shape, voxel):
    """The boundary of the squares around those points of the lattice that lie inside: what an image of the shape knows of it."""
    corners = polygon(shape)
    low, high = numpy.floor(corners.min(0) / voxel).astype(int) - 1, numpy.ceil(corners.max(0) / voxel).astype(int) + 1
    inside = numpy.zeros(high - low + 1, bool)
    ys = (low[1] + numpy.arange(inside.shape[1])) * voxel
    for i in range(inside.shape[0]):
        x = (low[0] + i) * voxel
        for a, b in zip(corners, numpy.roll(corners, -1, 0)):
            if (a[0] <= x) != (b[0] <= x):
                inside[i] ^= ys < a[1] + (x - a[0]) * (b[1] - a[1]) / (b[0] - a[0])
    follows = {}  # of each corner of squares the next one, the inside to the left
    for i, j in numpy.argwhere(inside):
        for (di, dj), a, b in (((0, -1), (0, 0), (1, 0)), ((1, 0), (1, 0), (1, 1)), ((0, 1), (1, 1), (0, 1)), ((-1, 0), (0, 1), (0, 0))):
            if not inside[i + di, j + dj]:
                assert (i + a[0], j + a[1]) not in follows, "squares that touch at a corner"
                follows[i + a[0], j + a[1]] = (i + b[0], j + b[1])
    path = [next(iter(follows))]
    while follows[path[-1]] != path[0]:
        path.append(follows[path[-1]])
    assert len(path) == len(follows), "more than one outline"
    points = (numpy.array(path) + low - 0.5) * voxel
    turns = cross(numpy.roll(points, 1, 0), points, numpy.roll(points, -1, 0)) != 0
    points = [tuple(p) for p in points[turns]]
    return [Segment(a, b) for a, b in zip(points, points[1:] + points[:1])]


def write_solid(path, shape, half_depth):
    """The shape between -half_depth and half_depth. Where that is deeper than any limit, its middle is the plane shape's own field."""
    corners = polygon(shape)
    n = len(corners)
    lines = ["v %.9g %.9g %.9g" % (x, y, z) for z in (-half_depth, half_depth) for x, y in corners]
    triangles = []
    for i in range(n):
        j = (i + 1) % n
        triangles += [(i, j, j + n), (i, j + n, i + n)]
    for a, b, c in ears(corners):
        triangles += [(c, b, a), (a + n, b + n, c + n)]
    lines += ["f %d %d %d" % tuple(v + 1 for v in t) for t in triangles]
    path.write_text("\n".join(lines) + "\n")
