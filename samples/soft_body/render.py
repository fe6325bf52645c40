# SPDX-License-Identifier: Apache-2.0
"""Renders the motion of soft bodies and puts the pictures on one sheet: a row a body, time from left to right.

    soft_body shell.vdb --motion shell_frames
    blender --background --factory-startup --python samples/soft_body/render.py -- \
        sheet.png shell_frames solid_frames [--names "shell" "solid"] [--columns 8] [--up y] [--size 240]

A folder has frame_0000.obj and so on, as soft_body writes them; each picture stands beside its frame as .png. With
--all every frame is rendered, for a film. All bodies are seen by the camera that suits the first. Written for Blender
3.4; needs nothing but Blender and its numpy.
"""

import argparse
import math
import pathlib
import sys

import bpy
import numpy as np
from mathutils import Matrix, Vector


def arguments():
    own = sys.argv[sys.argv.index("--") + 1:] if "--" in sys.argv else []
    parser = argparse.ArgumentParser(prog="render.py")
    parser.add_argument("sheet", help=".png to write")
    parser.add_argument("folders", nargs="+", type=pathlib.Path)
    parser.add_argument("--names", nargs="*", default=[], help="what is written into the rows")
    parser.add_argument("--columns", type=int, default=8)
    parser.add_argument("--all", action="store_true", help="render every frame, not only those of the sheet")
    parser.add_argument("--up", choices=("x", "y", "z"), default="y", help="axis of the bodies that is up")
    parser.add_argument("--turn", type=float, default=20, help="degrees around the upright axis")
    parser.add_argument("--size", type=int, default=240, help="pixels of a picture's side")
    parser.add_argument("--samples", type=int, default=16)
    parser.add_argument("--levels", type=int, default=255, help="of each colour in the sheet; 20 make a small file")
    return parser.parse_args(own)


def read_obj(path):
    points, triangles = [], []
    for line in path.read_text().splitlines():
        words = line.split()
        if words[0] == "v":
            points.append([float(word) for word in words[1:4]])
        elif words[0] == "f":
            triangles.append([int(word) - 1 for word in words[1:4]])
    return np.array(points), triangles


def frames_of(folder):
    found = sorted(folder.glob("frame_*.obj"))
    if not found:
        sys.exit(f"{folder}: no frame_*.obj")
    return found


def upright(options):
    """Blender's z is up."""
    turns = {"x": Matrix.Rotation(math.radians(-90), 4, "Y"), "y": Matrix.Rotation(math.radians(90), 4, "X"),
             "z": Matrix.Identity(4)}
    return Matrix.Rotation(math.radians(options.turn), 4, "Z") @ turns[options.up]


def material(name, colour, roughness):
    made = bpy.data.materials.new(name)
    made.use_nodes = True
    shader = made.node_tree.nodes["Principled BSDF"]
    shader.inputs["Base Color"].default_value = (*colour, 1)
    shader.inputs["Roughness"].default_value = roughness
    return made


def add(name, data):
    thing = bpy.data.objects.new(name, data)
    bpy.context.collection.objects.link(thing)
    return thing


def add_scene(low, high):
    """Camera, sun and floor for a body between these corners; the text object for its name."""
    size, centre = high - low, (low + high) / 2
    extent = 1.6 * max(size)
    camera = bpy.data.cameras.new("camera")
    camera.type, camera.ortho_scale, camera.clip_end = "ORTHO", extent, 100 * extent
    eye = add("camera", camera)
    eye.location = centre + Vector((0, -4, 1)) * extent
    eye.rotation_euler = (centre - eye.location).to_track_quat("-Z", "Y").to_euler()
    bpy.context.scene.camera = eye
    sun = bpy.data.lights.new("sun", "SUN")
    sun.energy, sun.angle = 2.2, .1
    add("sun", sun).rotation_euler = (math.radians(45), math.radians(15), math.radians(30))
    floor = bpy.data.meshes.new("floor")
    far = 20 * extent
    corners = ((-1, -1), (1, -1), (1, 1), (-1, 1))
    floor.from_pydata([(centre.x + x * far, centre.y + y * far, low.z) for x, y in corners], [], [(0, 1, 2, 3)])
    floor.materials.append(material("floor", (.75, .75, .75), 1))
    add("floor", floor)
    text = bpy.data.curves.new("name", "FONT")
    text.size = .07 * extent
    text.materials.append(material("ink", (0, 0, 0), 1))
    sign = add("name", text)
    sign.parent = eye
    sign.location = (-.48 * extent, .42 * extent, -extent)
    return text


def set_up_render(options):
    scene = bpy.context.scene
    scene.world = scene.world or bpy.data.worlds.new("world")
    scene.world.use_nodes = True
    scene.world.node_tree.nodes["Background"].inputs["Color"].default_value = (.3, .33, .36, 1)
    scene.render.engine = "CYCLES"
    scene.cycles.device = "CPU"
    scene.cycles.samples = options.samples
    scene.cycles.use_denoising = False
    scene.view_settings.view_transform = "Standard"
    scene.render.resolution_x = scene.render.resolution_y = options.size
    scene.render.resolution_percentage = 100
    scene.render.image_settings.file_format = "PNG"
    scene.render.image_settings.color_mode = "RGB"


def render(frame, placing, skin):
    """The picture beside the frame."""
    points, triangles = read_obj(frame)
    mesh = bpy.data.meshes.new("body")
    mesh.from_pydata([placing @ Vector(p) for p in points], [], triangles)
    for polygon in mesh.polygons:
        polygon.use_smooth = True
    mesh.materials.append(skin)
    body = add("body", mesh)
    picture = frame.with_suffix(".png").resolve()
    bpy.context.scene.render.filepath = str(picture)
    bpy.ops.render.render(write_still=True)
    bpy.data.objects.remove(body)
    bpy.data.meshes.remove(mesh)
    return picture


def pixels(picture):
    image = bpy.data.images.load(str(picture))
    width, height = image.size
    return np.array(image.pixels[:]).reshape(height, width, 4)


def write_sheet(path, rows, levels):
    # Blender's rows of pixels run upwards.
    whole = np.concatenate([np.concatenate([pixels(p) for p in row], 1) for row in reversed(rows)], 0)
    whole = np.round(whole * levels) / levels
    sheet = bpy.data.images.new("sheet", whole.shape[1], whole.shape[0])
    sheet.pixels = whole.ravel().tolist()
    sheet.filepath_raw, sheet.file_format = str(pathlib.Path(path).resolve()), "PNG"
    sheet.save()


def main():
    options = arguments()
    for thing in list(bpy.data.objects):
        bpy.data.objects.remove(thing)
    placing, skin = upright(options), material("skin", (.8, .3, .15), .45)
    rest = [placing @ Vector(p) for p in read_obj(frames_of(options.folders[0])[0])[0]]
    low, high = (Vector(f(p[axis] for p in rest) for axis in range(3)) for f in (min, max))
    sign = add_scene(low, high)
    set_up_render(options)
    rows = []
    for number, folder in enumerate(options.folders):
        frames = frames_of(folder)
        shown = {round(i * (len(frames) - 1) / max(1, options.columns - 1)) for i in range(options.columns)}
        sign.body = options.names[number] if number < len(options.names) else folder.name
        pictures = {i: render(frame, placing, skin) for i, frame in enumerate(frames) if options.all or i in shown}
        rows.append([pictures[i] for i in sorted(shown)])
    write_sheet(options.sheet, rows, options.levels)
    print(f"sheet: {len(rows)} rows of {len(rows[0])} pictures")


main()
