# SPDX-License-Identifier: Apache-2.0
"""Brings a shell into Blender and renders it: the .vdb's grid "depth" as a glowing volume on the
left, the tets on the right, the near part cut away and coloured by depth.

    vdb_shell build mesh.obj -o shell.vdb -o shell.node
    blender --background --factory-startup --python samples/blender/show_shell.py -- \
        shell.vdb shell.node shell.png [--up y] [--size 640 360] [--samples 32]

Written for Blender 3.4. It needs nothing but Blender; run it without --background to look around.
"""

import argparse
import math
import os
import sys

import bpy
from mathutils import Matrix, Vector


def own_words():
    """What stands behind "--": the rest is Blender's."""
    return sys.argv[sys.argv.index("--") + 1:] if "--" in sys.argv else []


def add_picture_options(parser):
    parser.add_argument("--up", choices=("y", "z"), default="z", help="axis of what is shown that is up")
    parser.add_argument("--size", type=int, nargs=2, default=(640, 360))
    parser.add_argument("--samples", type=int, default=32)


def arguments():
    parser = argparse.ArgumentParser(prog="show_shell.py")
    parser.add_argument("volume", help="the .vdb")
    parser.add_argument("tets", help="the .node, its .ele beside it")
    parser.add_argument("picture", help=".png to write")
    add_picture_options(parser)
    return parser.parse_args(own_words())


def clear_scene():
    for thing in list(bpy.data.objects):
        bpy.data.objects.remove(thing)


def upright_matrix(up, turn=0):
    """Blender's z is up; `turn` in degrees about that."""
    return (Matrix.Rotation(math.radians(turn), 4, "Z")
            @ Matrix.Rotation(math.radians(90 if up == "y" else 0), 4, "X"))


def rows(path):
    with open(path, encoding="ascii") as file:
        lines = [line.split() for line in file if not line.startswith("#")]
    count = int(lines[0][0])
    assert len(lines) == count + 1, f"{path}: {len(lines) - 1} lines, {count} stated"
    return lines[1:]


def read_tets(node_file):
    """Points, layers, and the four corners of each tet."""
    nodes = rows(node_file)
    points = [Vector(map(float, row[1:4])) for row in nodes]
    layers = [int(row[5]) for row in nodes]
    tets = [tuple(map(int, row[1:5])) for row in rows(os.path.splitext(node_file)[0] + ".ele")]
    return points, layers, tets


def boundary(tets):
    """Triangles that belong to one tet only, outward."""
    faces = {}
    for t in tets:
        for corners in ((1, 2, 3), (0, 3, 2), (0, 1, 3), (0, 2, 1)):
            face = tuple(t[c] for c in corners)
            faces.setdefault(frozenset(face), []).append(face)
    return [found[0] for found in faces.values() if len(found) == 1]


def add_tets(points, layers, tets, upright):
    """The tets whose centre lies behind a plane through the middle, as one mesh."""
    placed = [upright @ p for p in points]
    middle = sum((p.y for p in placed)) / len(placed)
    kept = [t for t in tets if sum(placed[c].y for c in t) / 4 > middle]
    mesh = bpy.data.meshes.new("tets")
    mesh.from_pydata(placed, [], boundary(kept))
    depth = mesh.attributes.new("depth", "FLOAT", "POINT")
    last = max(layers) or 1
    for value, layer in zip(depth.data, layers):
        value.value = layer / last
    mesh.validate()
    thing = bpy.data.objects.new("tets", mesh)
    bpy.context.collection.objects.link(thing)
    print(f"tets: {len(kept)} of {len(tets)} behind the cut, {len(mesh.polygons)} triangles")
    return thing


def add_volume(path, upright):
    volume = bpy.data.volumes.new("volume")
    volume.filepath = os.path.abspath(path)
    thing = bpy.data.objects.new("volume", volume)
    thing.matrix_world = upright
    bpy.context.collection.objects.link(thing)
    if not volume.grids.load():
        sys.exit(f"Blender does not read {path}: {volume.grids.error_message}")
    print("grids: " + ", ".join(f"{grid.name} ({grid.data_type})" for grid in volume.grids))
    return thing


def new_material(name):
    material = bpy.data.materials.new(name)
    material.use_nodes = True
    nodes = material.node_tree.nodes
    nodes.clear()
    return material, nodes, material.node_tree.links, nodes.new("ShaderNodeOutputMaterial")


def depth_colours(nodes, links):
    attribute = nodes.new("ShaderNodeAttribute")
    attribute.attribute_name = "depth"
    ramp = nodes.new("ShaderNodeValToRGB")
    ramp.color_ramp.elements[0].color = (0.9, 0.35, 0.08, 1)
    ramp.color_ramp.elements[1].color = (0.05, 0.25, 0.9, 1)
    links.new(attribute.outputs["Fac"], ramp.inputs["Fac"])
    return attribute, ramp


def volume_material(size):
    """Glows in the colour of the depth; a ray through the whole object loses most of its light."""
    material, nodes, links, output = new_material("volume")
    attribute, ramp = depth_colours(nodes, links)
    shader = nodes.new("ShaderNodeVolumePrincipled")
    shader.inputs["Density Attribute"].default_value = ""
    # Empty space has depth 0, and would glow like the outer surface if nothing held it down.
    for socket, factor in (("Density", 6.0 / size), ("Emission Strength", 5.0 / size)):
        product = nodes.new("ShaderNodeMath")
        product.operation = "MULTIPLY"
        product.inputs[1].default_value = factor
        links.new(attribute.outputs["Fac"], product.inputs[0])
        links.new(product.outputs["Value"], shader.inputs[socket])
    links.new(ramp.outputs["Color"], shader.inputs["Emission Color"])
    links.new(shader.outputs["Volume"], output.inputs["Volume"])
    return material


def tet_material():
    material, nodes, links, output = new_material("tets")
    _, ramp = depth_colours(nodes, links)
    shader = nodes.new("ShaderNodeBsdfDiffuse")
    links.new(ramp.outputs["Color"], shader.inputs["Color"])
    links.new(shader.outputs["BSDF"], output.inputs["Surface"])
    return material


def add_camera_and_light(centre, width, height):
    camera = bpy.data.cameras.new("camera")
    camera.type = "ORTHO"
    camera.ortho_scale = 1.08 * width
    eye = bpy.data.objects.new("camera", camera)
    eye.location = centre + Vector((0, -4, 1.4)) * max(width, height)
    eye.rotation_euler = (centre - eye.location).to_track_quat("-Z", "Y").to_euler()
    camera.clip_end = 100 * max(width, height)
    sun = bpy.data.lights.new("sun", "SUN")
    sun.energy = 3.0
    lamp = bpy.data.objects.new("sun", sun)
    lamp.rotation_euler = (math.radians(50), math.radians(15), math.radians(20))
    for thing in (eye, lamp):
        bpy.context.collection.objects.link(thing)
    bpy.context.scene.camera = eye


def render(picture, size, samples, background=0.02):
    scene = bpy.context.scene
    world = scene.world or bpy.data.worlds.new("world")
    scene.world = world
    world.use_nodes = True
    world.node_tree.nodes["Background"].inputs["Color"].default_value = (background, background, background, 1)
    scene.render.engine = "CYCLES"
    scene.cycles.device = "CPU"
    scene.cycles.samples = samples
    scene.cycles.use_denoising = False
    scene.view_settings.view_transform = "Standard"
    scene.render.resolution_x, scene.render.resolution_y = size
    scene.render.resolution_percentage = 100
    scene.render.image_settings.file_format = "PNG"
    scene.render.image_settings.color_mode = "RGB"
    scene.render.filepath = os.path.abspath(picture)
    bpy.ops.render.render(write_still=True)


def main():
    options = arguments()
    clear_scene()
    upright = upright_matrix(options.up)
    points, layers, tets = read_tets(options.tets)
    placed = [upright @ p for p in points]
    low, high = (Vector(f(p[axis] for p in placed) for axis in range(3)) for f in (min, max))
    size, centre = high - low, (low + high) / 2
    gap = Vector((0.575 * size.x, 0, 0))

    solid = add_tets(points, layers, tets, upright)
    solid.data.materials.append(tet_material())
    solid.location = gap
    fog = add_volume(options.volume, Matrix.Translation(-gap) @ upright)
    fog.data.materials.append(volume_material(max(size)))
    add_camera_and_light(centre, max(2.15 * size.x, size.z * options.size[0] / options.size[1]), size.z)
    render(options.picture, options.size, options.samples)


if __name__ == "__main__":
    main()
