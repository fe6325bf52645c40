# SPDX-License-Identifier: Apache-2.0
"""Renders grids of a .vdb as solid bodies: each is the surface where a grid of floats is one half.

    blender --background --factory-startup --python samples/blender/show_solids.py -- \
        wall.vdb picture.png --body bricks:0.5,0.15,0.08 --body mortar:0.6,0.57,0.52 --up y --turn 60
    blender --background --factory-startup --python samples/blender/show_solids.py -- \
        marble.vdb picture.png --body solid --colour vein --up y --turn 90

--body is the name of a grid and a colour; --colour the name of a grid between 0 and 1 that says where between
two colours of marble a body is. Written for Blender 3.4 with pyopenvdb, as Debian has them.
"""

import argparse
import os
import sys

import bpy
import numpy
import pyopenvdb as vdb
from mathutils import Vector

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from show_shell import (add_camera_and_light, add_picture_options, clear_scene, new_material,  # noqa: E402
                        own_words, render, upright_matrix)

PALE, DARK = numpy.array([0.85, 0.82, 0.76]), numpy.array([0.04, 0.11, 0.10])


def arguments():
    parser = argparse.ArgumentParser(prog="show_solids.py")
    parser.add_argument("volume", help="the .vdb")
    parser.add_argument("picture", help=".png to write")
    parser.add_argument("--body", action="append", required=True, help="GRID or GRID:RED,GREEN,BLUE")
    parser.add_argument("--colour", help="grid that colours the bodies")
    parser.add_argument("--turn", type=float, default=0, help="degrees about the axis that is up")
    add_picture_options(parser)
    return parser.parse_args(own_words())


def values_at(grid, points):
    """Trilinear, of a grid that scales alike."""
    low, high = grid.evalActiveVoxelBoundingBox()
    dense = numpy.zeros([b - a + 2 for a, b in zip(low, high)], numpy.float32)
    grid.copyToArray(dense, ijk=low)
    places = (points - numpy.array(grid.transform.indexToWorld(low))) / grid.transform.voxelSize()[0]
    places = numpy.clip(places, 0, numpy.array(dense.shape) - 1.001)
    base = places.astype(int)
    share = places - base
    total = numpy.zeros(len(points))
    for step in numpy.ndindex(2, 2, 2):
        weight = numpy.where(numpy.array(step) == 1, share, 1 - share).prod(axis=1)
        total += weight * dense[tuple((base + step).T)]
    return total


def add_body(grid, colours, upright):
    points, quads = grid.convertToQuads(isovalue=0.5)
    mesh = bpy.data.meshes.new(grid.name)
    # OpenVDB turns polygons the other way round, and takes what is below the value for the inside.
    mesh.from_pydata(points.tolist(), [], quads.tolist())
    if colours is not None:
        shares = numpy.clip(values_at(colours, points), 0, 1)[:, None]
        attribute = mesh.attributes.new("colour", "FLOAT_COLOR", "POINT")
        rgb = (1 - shares) * DARK + shares * PALE
        attribute.data.foreach_set("color", numpy.hstack([rgb, numpy.ones_like(shares)]).ravel())
    mesh.polygons.foreach_set("use_smooth", [True] * len(mesh.polygons))
    body = bpy.data.objects.new(grid.name, mesh)
    body.matrix_world = upright
    bpy.context.collection.objects.link(body)
    print(f"{grid.name}: {len(points)} points")
    return body


def stone(colour):
    """None: of the attribute, and polished."""
    material, nodes, links, output = new_material("stone")
    shader = nodes.new("ShaderNodeBsdfPrincipled")
    shader.inputs["Roughness"].default_value = 0.9 if colour else 0.35
    if colour:
        shader.inputs["Base Color"].default_value = (*colour, 1)
    else:
        attribute = nodes.new("ShaderNodeAttribute")
        attribute.attribute_name = "colour"
        links.new(attribute.outputs["Color"], shader.inputs["Base Color"])
    links.new(shader.outputs["BSDF"], output.inputs["Surface"])
    return material


def main():
    options = arguments()
    clear_scene()
    upright = upright_matrix(options.up, options.turn)
    colours = vdb.read(options.volume, options.colour) if options.colour else None
    corners = []
    for words in options.body:
        name, _, colour = words.partition(":")
        body = add_body(vdb.read(options.volume, name), colours, upright)
        body.data.materials.append(stone([float(c) for c in colour.split(",")] if colour else None))
        corners += [upright @ Vector(corner) for corner in body.bound_box]
    low, high = (Vector(f(c[axis] for c in corners) for axis in range(3)) for f in (min, max))
    size = high - low
    width, height = options.size
    add_camera_and_light((low + high) / 2, max(size.x, 1.15 * size.z * width / height), size.z)
    render(options.picture, options.size, options.samples, background=0.25)


if __name__ == "__main__":
    main()
