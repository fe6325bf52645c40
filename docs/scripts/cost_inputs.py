# SPDX-License-Identifier: Apache-2.0
"""The surfaces of cost_of_inputs.py: each maker takes about how many triangles are wanted and gives points and
triangles that are hard for some stage. All are the same at each call."""
import math
import random


class Welded:
    """Points that are told apart by a key."""

    def __init__(self):
        self.points, self.index = [], {}

    def at(self, key, point):
        if key not in self.index:
            self.index[key] = len(self.points)
            self.points.append(point)
        return self.index[key]


def tets_of_grid(cells):
    """The points and tets of a cube of cells cut into six tets each (Kuhn), with points moved by up to a fifth."""
    source, grid, tets = random.Random(1), Welded(), []

    def at(*key):
        if key not in grid.index:
            grid.at(key, tuple(c + source.uniform(-.2, .2) for c in key))
        return grid.index[key]

    for i in range(cells):
        for j in range(cells):
            for k in range(cells):
                for x, y in ((0, 1), (1, 0), (0, 2), (2, 0), (1, 2), (2, 1)):
                    a, b, c, d = ([i, j, k] for _ in range(4))
                    b[x] += 1
                    c[x] += 1
                    c[y] += 1
                    d = [i + 1, j + 1, k + 1]
                    corners = [at(*p) for p in (a, b, c, d)]
                    even = (x, y) in ((0, 1), (1, 2), (2, 0))
                    tets.append(tuple(corners if even else [corners[n] for n in (0, 1, 3, 2)]))
    return grid.points, tets


def faces_of(tet):
    a, b, c, d = tet
    return (a, c, b), (a, b, d), (b, c, d), (a, d, c)


def tet_faces(n):
    """All faces of a tet mesh, each once: nearly every edge has four triangles and more."""
    points, tets = tets_of_grid(max(1, round((n / 12) ** (1 / 3))))
    seen, triangles = set(), []
    for tet in tets:
        for face in faces_of(tet):
            if tuple(sorted(face)) not in seen:
                seen.add(tuple(sorted(face)))
                triangles.append(face)
    return points, triangles


def tet_boundaries(n):
    """The four faces of each tet of a mesh: nearly all of them twice, turned against each other."""
    points, tets = tets_of_grid(max(1, round((n / 24) ** (1 / 3))))
    return points, [face for tet in tets for face in faces_of(tet)]


def height_field(n):
    """A terrain: one open sheet."""
    source, side = random.Random(2), max(2, round(math.sqrt(n / 2)))
    points = [(i, j, 3 * math.sin(i / 9) * math.cos(j / 7) + source.uniform(-.4, .4))
              for i in range(side + 1) for j in range(side + 1)]
    triangles = []
    for i in range(side):
        for j in range(side):
            a = i * (side + 1) + j
            triangles += [(a, a + side + 1, a + 1), (a + 1, a + side + 1, a + side + 2)]
    return points, triangles


def box(low, high):
    points = [tuple(high[k] if i >> k & 1 else low[k] for k in range(3)) for i in range(8)]
    quads = (0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)
    return points, [t for a, b, c, d in quads for t in ((a, b, c), (a, c, d))]


def one_repeated(n):
    """A box, one of whose triangles is there n times."""
    points, triangles = box((0, 0, 0), (1, 1, 1))
    return points, triangles + [triangles[0]] * n


def all_doubled(n):
    """A closed surface, each triangle twice, turned against each other."""
    points, triangles = sphere(n // 2, 1)
    return points, triangles + [(a, c, b) for a, b, c in triangles]


def fins(n):
    """Triangles around one edge, like the pages of a book."""
    angles = [2 * math.pi * i / n for i in range(n)]
    return [(0, 0, 0), (0, 0, 1)] + [(math.cos(a), math.sin(a), .5) for a in angles], [
        (0, 1, i + 2) for i in range(n)]


def sphere(n, radius, centre=(0, 0, 0)):
    """By latitude and longitude."""
    rings = max(2, round(math.sqrt(n / 4)))
    around = 2 * rings
    points = [(0, 0, radius)]
    for i in range(1, rings):
        z, r = math.cos(math.pi * i / rings), math.sin(math.pi * i / rings)
        points += [(radius * r * math.cos(2 * math.pi * j / around), radius * r * math.sin(2 * math.pi * j / around),
                    radius * z) for j in range(around)]
    points.append((0, 0, -radius))
    triangles, last = [], len(points) - 1
    for j in range(around):
        k = (j + 1) % around
        triangles += [(0, 1 + j, 1 + k), (last, last - around + k, last - around + j)]
        for i in range(rings - 2):
            a, b = 1 + i * around + j, 1 + i * around + k
            triangles += [(a, a + around, b), (b, a + around, b + around)]
    return [tuple(x + c for x, c in zip(point, centre)) for point in points], triangles


def joined(parts):
    points, triangles = [], []
    for more, faces in parts:
        triangles += [tuple(v + len(points) for v in face) for face in faces]
        points += more
    return points, triangles


def one_vertex(n):
    """Two cones over one rim: each apex has half of the triangles."""
    half = n // 2
    points = [(math.cos(2 * math.pi * i / half), math.sin(2 * math.pi * i / half), 0) for i in range(half)]
    points += [(0, 0, 1), (0, 0, -1)]
    rim = [(i, (i + 1) % half) for i in range(half)]
    return points, [(a, b, half) for a, b in rim] + [(b, a, half + 1) for a, b in rim]


def fan_caps(n):
    """A cylinder whose caps are fans about their middles."""
    around = n // 4
    rim = [(math.cos(2 * math.pi * i / around), math.sin(2 * math.pi * i / around)) for i in range(around)]
    points = [(x, y, z) for z in (0, 1) for x, y in rim] + [(0, 0, 0), (0, 0, 1)]
    triangles = []
    for i in range(around):
        j = (i + 1) % around
        triangles += [(i, j, around + i), (j, around + j, around + i), (2 * around, j, i),
                      (2 * around + 1, around + i, around + j)]
    return points, triangles


def fans_at_a_point(n):
    """Small tets that have one corner in common."""
    source, points, triangles = random.Random(3), [(0, 0, 0)], []
    for _ in range(n // 4):
        away = [source.gauss(0, 1) for _ in range(3)]
        length = math.sqrt(sum(c * c for c in away))
        first = len(points)
        points += [tuple(c / length + .1 / math.sqrt(n) * source.gauss(0, 1) for c in away) for _ in range(3)]
        triangles += faces_of((0, first, first + 1, first + 2))
    return points, triangles


def nested_spheres(n):
    """A hundred of them, each in the one before it."""
    return joined(sphere(n // 100, 1 + .1 * i) for i in range(100))


def deep_spheres(n):
    """The same, a thousand deep at 80,000: the number of them grows, and not that of their triangles."""
    return joined(sphere(80, 1 + i) for i in range(max(1, n // 80)))


def many_components(n):
    """Octahedra, apart from one another."""
    side = math.ceil((n / 8) ** (1 / 3))
    places = [(i, j, k) for i in range(side) for j in range(side) for k in range(side)]
    return joined(sphere(8, .4, place) for place in places[:max(1, n // 8)])


def holes_of_sphere(n):
    """A sphere without every eighth triangle: as many holes as that."""
    points, triangles = sphere(n, 1)
    return points, [t for i, t in enumerate(triangles) if i % 8 != 4]


def needles(n):
    """Long, thin triangles in all directions; their boxes overlap, and few of them cross."""
    source, points, triangles = random.Random(4), [], []
    for _ in range(n):
        first = len(points)
        a, b = ([source.uniform(0, 1) for _ in range(3)] for _ in range(2))
        points += [tuple(a), tuple(b), tuple(c + 1e-5 * source.gauss(0, 1) for c in b)]
        triangles.append((first, first + 1, first + 2))
    return points, triangles


def soup(n):
    """Small triangles in any place and direction: each crosses one or two others."""
    source, points, triangles, size = random.Random(5), [], [], n ** (-1 / 3)
    for _ in range(n):
        centre = [source.uniform(0, 1) for _ in range(3)]
        triangles.append((len(points), len(points) + 1, len(points) + 2))
        points += [tuple(c + size * source.uniform(-.8, .8) for c in centre) for _ in range(3)]
    return points, triangles


def in_one_voxel(n):
    """A box, and in the middle of it a ball smaller than a voxel that has all other triangles."""
    return joined([box((-1, -1, -1), (1, 1, 1)), sphere(n, 1e-4)])


def long_rim(n):
    """A strip that winds up a tube: one hole whose rim is as long as the surface."""
    turns = 20
    points = [(math.cos(2 * math.pi * turns * i / n), math.sin(2 * math.pi * turns * i / n),
               (i + 10 * (i % 2) * n / 20 / turns) / n) for i in range(n)]
    return points, [(i, i + 1, i + 2) if i % 2 else (i + 1, i, i + 2) for i in range(n - 2)]


MAKERS = {maker.__name__: maker for maker in (
    tet_faces, tet_boundaries, height_field, one_repeated, all_doubled, fins, one_vertex, fan_caps, fans_at_a_point,
    nested_spheres, deep_spheres, many_components, holes_of_sphere, needles, soup, in_one_voxel, long_rim)}
