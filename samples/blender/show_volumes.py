# SPDX-License-Identifier: Apache-2.0
"""Renders the grid "density" of .vdb files side by side, as smoke lit by the sun.

    vdb_shell volumes rest.vdb --volumes density --density-ramp 0:1,0.2:1,0.25:0 -o smoke.vdb
    vdb_shell deform smoke.vdb --posed posed.vdb -o posed_smoke.vdb
    blender --background --factory-startup --python samples/blender/show_volumes.py -- \
        smoke.vdb posed_smoke.vdb picture.png [--up y] [--turn 90] [--size 640 360] [--samples 32]

Written for Blender 3.4.
"""

import argparse
import os
import sys

import bpy
from mathutils import Vector

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from show_shell import (add_camera_and_light, add_picture_options, add_volume, clear_scene,  # noqa: E402
                        new_material, own_words, render, upright_matrix)


def arguments():
    parser = argparse.ArgumentParser(prog="show_volumes.py")
    parser.add_argument("files", nargs="+", help="one or more .vdb, and last the .png to write")
    parser.add_argument("--turn", type=float, default=0, help="degrees about the axis that is up")
    parser.add_argument("--light", type=float, default=3, help="strength of the sun")
    add_picture_options(parser)
    return parser.parse_args(own_words())


def smoke(size):
    """A way of a fourteenth of the size of the object through density 1 takes two thirds of the light."""
    material, nodes, links, output = new_material("smoke")
    attribute = nodes.new("ShaderNodeAttribute")
    attribute.attribute_name = "density"
    product = nodes.new("ShaderNodeMath")
    product.operation = "MULTIPLY"
    product.inputs[1].default_value = 14.0 / size
    shader = nodes.new("ShaderNodeVolumePrincipled")
    shader.inputs["Density Attribute"].default_value = ""
    shader.inputs["Color"].default_value = (1.0, 0.9, 0.8, 1)
    links.new(attribute.outputs["Fac"], product.inputs[0])
    links.new(product.outputs["Value"], shader.inputs["Density"])
    links.new(shader.outputs["Volume"], output.inputs["Volume"])
    return material


def main():
    options = arguments()
    *volumes, picture = options.files
    clear_scene()
    upright = upright_matrix(options.up, options.turn)
    made = [add_volume(volume, upright) for volume in volumes]
    bpy.context.view_layer.update()
    boxes = []
    for thing in made:
        corners = [thing.matrix_world @ Vector(corner) for corner in thing.bound_box]
        boxes.append([Vector(f(c[axis] for c in corners) for axis in range(3)) for f in (min, max)])
    size = Vector(max(box[1][axis] - box[0][axis] for box in boxes) for axis in range(3))
    step = 1.08 * size.x
    for i, (thing, (low, high)) in enumerate(zip(made, boxes)):
        middle = (low + high) / 2
        thing.location = thing.location - middle + Vector(((i - (len(made) - 1) / 2) * step, 0, 0))
        thing.data.materials.append(smoke(max(size)))
    width, height = options.size
    add_camera_and_light(Vector((0, 0, 0)), max(len(made) * step, 1.3 * size.z * width / height), size.z)
    bpy.data.lights["sun"].energy = options.light
    render(picture, options.size, options.samples)


if __name__ == "__main__":
    main()
