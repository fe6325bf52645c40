# SPDX-License-Identifier: Apache-2.0
"""The three situations of the paper's figure 2 as solids: convex polygons, extruded, turned off all axes and off the voxels."""
import math

SHIFT = (0.0031, 0.0072, 0.0013)


def radians(degrees):
    return degrees * math.pi / 180


class Situation:
    """A polygon (counter-clockwise, the solid to its left), the vertex that is watched, where it ought to stop and why."""

    def __init__(self, figure, name, polygon, watched, half_depth, wanted, sheet_angle, why):
        self.figure, self.name, self.polygon, self.watched = figure, name, polygon, watched
        self.half_depth, self.wanted, self.sheet_angle, self.why = half_depth, wanted, sheet_angle, why

    def normals(self):
        """Inward unit normals and offsets of the polygon's sides: depth = n . x - c."""
        sides = []
        for a, b in zip(self.polygon, self.polygon[1:] + self.polygon[:1]):
            length = math.dist(a, b)
            n = (-(b[1] - a[1]) / length, (b[0] - a[0]) / length)
            sides.append((n, n[0] * a[0] + n[1] * a[1]))
        return sides

    def direction(self):
        """The inward direction of the watched vertex: between its two sides."""
        sides = self.normals()
        (a, _), (b, _) = sides[self.watched - 1], sides[self.watched]
        length = math.hypot(a[0] + b[0], a[1] + b[1])
        return ((a[0] + b[0]) / length, (a[1] + b[1]) / length)

    def slopes(self, count=20000):
        """(length, depth, slope of depth) along the watched line in the exact field, by steps."""
        p, d = self.polygon[self.watched], self.direction()
        sides = self.normals()
        step = 2 * max(math.dist(p, q) for q in self.polygon) / count
        for i in range(1, count):
            e = i * step
            q = (p[0] + e * d[0], p[1] + e * d[1])
            depth, n = min((n[0] * q[0] + n[1] * q[1] - c, n) for n, c in sides)
            if depth < 0:
                return
            yield e, depth, n[0] * d[0] + n[1] * d[1]

    def exact_end(self, threshold):
        """Where a test "slope > threshold" ends in the exact field."""
        end = 0
        for e, _, slope in self.slopes():
            if slope <= threshold:
                break
            end = e
        return end

    def mesh(self):
        """Points and triangles; three rows of vertices, so that the watched one is far from both caps."""
        rows = [-self.half_depth, 0, self.half_depth]
        n = len(self.polygon)
        points = [turned((x, y, z)) for z in rows for x, y in self.polygon]
        centre = [sum(c) / n for c in zip(*self.polygon)]
        triangles = []
        for row in range(2):
            for i in range(n):
                a, b = row * n + i, row * n + (i + 1) % n
                triangles += [(a, b, b + n), (a, b + n, a + n)]
        for row, front in ((0, False), (2, True)):
            points.append(turned((centre[0], centre[1], rows[row])))
            for i in range(n):
                a, b = row * n + i, row * n + (i + 1) % n
                triangles.append((a, b, len(points) - 1) if front else (b, a, len(points) - 1))
        return points, triangles

    def watched_vertex(self):
        return len(self.polygon) + self.watched


def turned(p):
    for axis, angle in ((0, 0.31), (1, 0.52), (2, 0.83)):
        i, j = (axis + 1) % 3, (axis + 2) % 3
        c, s = math.cos(angle), math.sin(angle)
        q = list(p)
        q[i], q[j] = c * p[i] - s * p[j], s * p[i] + c * p[j]
        p = q
    return [x + y for x, y in zip(p, SHIFT)]


def write_obj(path, situation):
    points, triangles = situation.mesh()
    lines = ["v %.9g %.9g %.9g" % tuple(p) for p in points] + ["f %d %d %d" % tuple(i + 1 for i in t) for t in triangles]
    path.write_text("\n".join(lines) + "\n")


def cross_over(degrees):
    a, d = radians(degrees), 0.25
    left = (-3 * math.cos(a), 3 * math.sin(a))
    polygon = [left, (0, 0), (d, 0), (3, 0), (3, 5), (left[0], 5)]
    return Situation("2a", f"cross-over, {degrees} degrees", polygon, 2, 3, d / math.tan(a / 2), a / 2,
                     "d / tan(a/2): the line meets the sheet of the ridge beside it")


def tentacle(degrees):
    b, w, side = radians(degrees), 0.5, 6
    x, y = w + side * math.sin(b), side * math.cos(b)
    top = y + 2 * x
    polygon = [(-w, 0), (0, 0), (w, 0), (x, y), (x, top), (-x, top), (-x, y)]
    return Situation("2b", f"tentacle, {degrees} degrees", polygon, 1, 7, w * math.tan(radians(45) + b / 2),
                     radians(45) - b / 2, "w tan(45 + b/2): the blunt end's own region is used up")


def wanted_walk(degrees):
    """A wedge cut off flat: the sharp edge walks until the far side is as near as its own."""
    b, length = radians(degrees), 3
    x = length * math.tan(b)
    polygon = [(0, 0), (x, length), (-x, length)]
    # Depth e sin b along the sheet, length - e above: equal at the junction.
    return Situation("2c", f"wanted walk, {2 * degrees} degrees", polygon, 0, 3, length / (1 + math.sin(b)), radians(90),
                     "L / (1 + sin b): the sheet's junction with those of the far corners")


def wanted_walk_box():
    polygon = [(0, 0), (4, 0), (4, 2), (0, 2)]
    return Situation("2c", "wanted walk, bar", polygon, 0, 3, math.sqrt(2), radians(90),
                     "h sqrt 2: half the bar's height along the diagonal")


SITUATIONS = [cross_over(20), cross_over(24), tentacle(70), tentacle(45), wanted_walk_box(), wanted_walk(30), wanted_walk(60)]
