#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Makes what volume_pictures.sh puts into a shell: texture coordinates, bricks, smoke and marble.

    make_volumes.py unwrap MESH.obj TEXTURED.obj    texture coordinates by box projection, y up
    make_volumes.py bricks BRICKS.vdb               one brick of two courses, and the mortar around
    make_volumes.py smoke DENSITY.vdb SMOKE.vdb     the grid "density" times noise
    make_volumes.py marble DEPTH.vdb MARBLE.vdb     veins of the grid "depth" with noise; half of it left out

For Debian's /usr/bin/python3 with python3-numpy and python3-openvdb.
"""

import sys

import numpy
import pyopenvdb as vdb

BRICK_LENGTH, COURSE = 0.20, 0.08  # world units of the surface, mortar included
MORTAR = 0.016


def read_obj(path):
    """Points, and the corners of each polygon."""
    points, faces = [], []
    with open(path, encoding="ascii") as file:
        for line in file:
            words = line.split()
            if words and words[0] == "v":
                points.append([float(w) for w in words[1:4]])
            elif words and words[0] == "f":
                faces.append([int(w.split("/")[0]) - 1 for w in words[1:]])
    return numpy.array(points), faces


def face_normals(points, faces):
    """Unit normals, by the areas projected onto the axes (Newell)."""
    normals = []
    for face in faces:
        corners = points[face]
        normals.append(numpy.cross(corners, numpy.roll(corners, -1, axis=0)).sum(axis=0))
    normals = numpy.array(normals)
    return normals / numpy.linalg.norm(normals, axis=1, keepdims=True)


def smoothed(values, faces, count, rounds):
    """Means over neighbours, so that charts do not end in single faces."""
    for _ in range(rounds):
        at_points = numpy.zeros((count, 3))
        for face, value in zip(faces, values):
            at_points[face] += value
        values = numpy.array([at_points[face].sum(axis=0) for face in faces])
        values /= numpy.linalg.norm(values, axis=1, keepdims=True)
    return values


def unwrap(mesh, textured):
    """Each face is projected along the axis that its normal is nearest to; u and v are world units. Courses are level wherever the
    surface is steep, and go on from chart to chart there, for v is the height."""
    points, faces = read_obj(mesh)
    normals = smoothed(face_normals(points, faces), faces, len(points), 4)
    # Along y only where it is flat enough: bricks on slopes may be stretched to twice their height.
    axes = numpy.abs(normals * [1, 0.6, 1]).argmax(axis=1)
    lines, corners = [], 0
    with open(mesh, encoding="ascii") as file:
        lines += [line.rstrip() for line in file if line.startswith("v ")]
    polygons = []
    for face, normal, axis in zip(faces, normals, axes):
        side = numpy.zeros(3)
        side[axis] = numpy.sign(normal[axis])
        up = numpy.array([0, 0, 1.0]) if axis == 1 else numpy.array([0, 1.0, 0])
        right = numpy.cross(up, side)
        for corner in face:
            lines.append(f"vt {points[corner] @ right:.6f} {points[corner] @ up:.6f}")
        polygons.append("f " + " ".join(f"{c + 1}/{corners + k + 1}" for k, c in enumerate(face)))
        corners += len(face)
    with open(textured, "w", encoding="ascii") as out:
        out.write("\n".join(lines + polygons) + "\n")
    print(f"{len(faces)} faces, by axis: {numpy.bincount(axes, minlength=3)}")


def lattice_noise(places, seed):
    """Value noise between -1 and 1: random values on the whole numbers, smoothly interpolated."""
    values = numpy.random.default_rng(seed).uniform(-1, 1, (32, 32, 32))
    base = numpy.floor(places).astype(int)
    share = places - base
    share = share * share * (3 - 2 * share)
    total = numpy.zeros(places.shape[:-1])
    for step in numpy.ndindex(2, 2, 2):
        weight = numpy.where(numpy.array(step) == 1, share, 1 - share).prod(axis=-1)
        i, j, k = numpy.moveaxis((base + step) % 32, -1, 0)
        total += weight * values[i, j, k]
    return total


def turbulence(places, octaves):
    return sum(lattice_noise(places * 2**o, o) / 2**o for o in range(octaves))


def grid_of(name, values, background):
    """All voxels are active, so that the tile is the whole box."""
    grid = vdb.FloatGrid(background)
    grid.name = name
    grid.fill((0, 0, 0), tuple(n - 1 for n in values.shape), 0.0, active=True)
    grid.copyFromArray(values.astype(numpy.float32))
    return grid


def bricks(path):
    """Densities that cross one half on the surface of the bricks, and on that of the mortar, over a few voxels."""
    count = numpy.array([100, 80, 16])  # voxels of 2 mm
    size = numpy.array([BRICK_LENGTH, 2 * COURSE])
    x, y, z = numpy.meshgrid(*((numpy.arange(n) + 0.5) / n for n in count), indexing="ij")
    course = numpy.floor(2 * y)
    along = (x + 0.5 * course) % 1 * size[0]
    up = (2 * y) % 1 * COURSE
    inside = numpy.minimum(numpy.minimum(along, size[0] - along), numpy.minimum(up, COURSE - up)) - MORTAR / 2
    round_edge = numpy.minimum(inside - 0.35 * MORTAR * numpy.maximum(0, z - 0.75) / 0.25, 0.5 * MORTAR)
    vdb.write(path, grids=[grid_of("bricks", numpy.clip(0.5 + round_edge / MORTAR, 0.01, 0.99), 0.0),
                           grid_of("mortar", numpy.where(z < 0.55, 0.99, 0.01), 0.0)])


def dense(grid):
    """Values in the box of active voxels, and places of their centres."""
    low, high = grid.evalActiveVoxelBoundingBox()
    values = numpy.zeros([b - a + 1 for a, b in zip(low, high)], numpy.float32)
    grid.copyToArray(values, ijk=low)
    origin = numpy.array(grid.transform.indexToWorld(low))
    size = grid.transform.voxelSize()[0]
    places = origin + size * numpy.stack(numpy.indices(values.shape), axis=-1)
    return values, places, low


def written_like(grid, name, values, low):
    made = vdb.FloatGrid(0.0)
    made.name = name
    made.transform = grid.transform
    made.gridClass = vdb.GridClass.FOG_VOLUME
    made.copyFromArray(values.astype(numpy.float32), ijk=low)
    return made


def smoke(source, path):
    grid = vdb.read(source, "density")
    values, places, low = dense(grid)
    wisps = 0.35 + 1.1 * turbulence(places * 5, 4)
    vdb.write(path, grids=[written_like(grid, "density", values * numpy.clip(wisps, 0, 1.5), low)])


def blurred(values):
    """Twice (1 2 1) / 4 along each axis, so that the surface at one half has no steps."""
    for _ in range(2):
        for axis in range(3):
            values = (numpy.roll(values, 1, axis) + 2 * values + numpy.roll(values, -1, axis)) / 4
    return values


def marble(source, path):
    """"solid" is 1 in the shell on the far side of a plane of constant x; "vein" is between 0 and 1 there."""
    grid = vdb.read(source, "depth")
    values, places, low = dense(grid)
    middle = 0.5 * (places[..., 0].min() + places[..., 0].max())
    solid = blurred(numpy.where((values > 0) & (places[..., 0] < middle), 1.0, 0.0))
    veins = 0.5 + 0.7 * numpy.sin(2 * numpy.pi * (4 * values + 0.4 * turbulence(places * 4, 4)))
    vdb.write(path, grids=[written_like(grid, "solid", solid, low),
                           written_like(grid, "vein", numpy.where(solid > 0, numpy.clip(veins, 1e-3, 1), 0), low)])


def main():
    makers = {"unwrap": (unwrap, 2), "bricks": (bricks, 1), "smoke": (smoke, 2), "marble": (marble, 2)}
    words = sys.argv[1:]
    if not words or words[0] not in makers or len(words) != 1 + makers[words[0]][1]:
        sys.exit(__doc__)
    makers[words[0]][0](*words[1:])


if __name__ == "__main__":
    main()
