#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Lets shells and a solid of one surface move under their weight (samples/soft_body) and has Blender draw them: a row
each, time from left to right. Makes docs/measurements/images/soft_body_bunny.png.

    soft_body_motion.py COMMAND SOFT_BODY MESH.obj PICTURE.png [--ours NAME="OPTIONS" ...] [--blender PROGRAM]

COMMAND is the vdb_shell binary, SOFT_BODY the sample's. The last row is TetGen's solid of the same unchanged surface,
-pYq1.414/14. Prints for each row the tets and the steps of conjugate gradients that its motion took. Frames are kept in
--cache, as tets are (tet_makers.py); other binaries are run again. Needs numpy and Blender 3.4.
"""
import argparse
import json
import pathlib
import subprocess

from shape_figures import ways_of
import tet_makers
from tet_makers import Maker, digest

SOLID = "TetGen -pYq1.414/14"
# More would be noise of the rendering, and four times the file.
LEVELS = 20
RENDER = pathlib.Path(__file__).parents[2] / "samples/soft_body/render.py"


def arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("command", type=pathlib.Path)
    parser.add_argument("soft_body", type=pathlib.Path)
    parser.add_argument("mesh", type=pathlib.Path)
    parser.add_argument("picture", type=pathlib.Path)
    rows = ["default=", "fewest tets=--for fewest-tets", "simulation=--for simulation"]
    tet_makers.add_arguments(parser, rows, 900, meshes=False)
    parser.add_argument("--blender", default="blender")
    parser.add_argument("--columns", type=int, default=6)
    parser.add_argument("--size", type=int, default=150, help="pixels of one picture's side")
    parser.add_argument("--samples", type=int, default=32)
    options = parser.parse_args()
    options.others = [SOLID]
    return options


def move(options, tets):
    """The folder of the frames, and what soft_body printed."""
    folder = tets.parent / f"motion-{digest(options.soft_body)[:12]}"
    said = folder / "said.json"
    if not said.exists():
        done = subprocess.run([str(options.soft_body), str(tets), "--motion", str(folder)], check=True,
                              capture_output=True, text=True, timeout=options.seconds)
        said.write_text(done.stdout)
    return folder, json.loads(said.read_text())


def main():
    options = arguments()
    maker = Maker(options.command.resolve(), options.cache, options.seconds)
    options.soft_body = options.soft_body.resolve()
    names, folders = [], []
    for name, words in ways_of(options).items():
        mesh = options.mesh.resolve()
        tets = maker.ours(mesh, words, ".vdb")[0] if words is not None else maker.others(mesh, name)
        folder, said = move(options, tets)
        print(f"{name}: {said['tets']} tets, {said['motion_steps']} steps for {said['frames']} frames", flush=True)
        names.append(f"{name}, {said['tets']} tets")
        folders.append(str(folder))
    subprocess.run([options.blender, "--background", "--factory-startup", "--python", str(RENDER), "--",
                    str(options.picture.resolve()), *folders, "--names", *names, "--columns", str(options.columns),
                    "--size", str(options.size), "--samples", str(options.samples), "--levels", str(LEVELS)],
                   check=True, stdout=subprocess.DEVNULL, timeout=options.seconds)


if __name__ == "__main__":
    main()
