#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Draws the pictures of docs/stages/taper.md: the tets on one side of a plane, before and after tapering, coloured by
their smallest dihedral angle.

    xvfb-run -a python3 docs/scripts/taper_pictures.py COMMAND PICTURE_FOLDER MESH:AXIS:POSITION ...

AXIS is x, y or z, POSITION the plane's share of the box along it; tets whose middle lies beyond are left out. Of each
MESH.obj comes a taper_MESH.png: the default shell, one tapered layer, two tapered layers. Needs Debian's python3-vtk9,
python3-numpy and xvfb.
"""
import pathlib
import subprocess
import sys
import tempfile

import numpy as np
import vtk
from vtk.util.numpy_support import numpy_to_vtk

from tet_files import read_tets
from tet_shapes import dihedral_degrees
from vtk_pictures import kept_cells, read_grid, save_png, window_of

WAYS = [[], ["--for", "fewest-tets"], ["--for", "simulation"]]
SIZE = 520
LARGEST_SHOWN = 30
# Red is a sliver, blue a good tet; sand between.
COLOURS = [(0, (.70, .09, .13)), (5, (.93, .45, .32)), (15, (.97, .86, .70)), (LARGEST_SHOWN, (.22, .45, .70))]
# From where the cut is seen: mostly along its axis, and a little from above.
DIRECTIONS = {"x": (1, .25, .3), "y": (.25, 1, .3), "z": (.25, .3, 1)}


def grid_of(mesh, words, command, folder):
    path = pathlib.Path(folder) / "tets.vtu"
    subprocess.run([command, "build", mesh, "-q", "--samples", "0", *words, "-o", path], check=True)
    points, tets = read_tets(path)
    grid = read_grid(path)
    angles = numpy_to_vtk(dihedral_degrees(points, tets).min(1), deep=True)
    angles.SetName("angle")
    grid.GetCellData().SetScalars(angles)
    return grid, points, tets


def one_side(grid, points, tets, axis, position):
    low, high = points[:, axis].min(), points[:, axis].max()
    kept = points[tets].mean(1)[:, axis] < low + position * (high - low)
    return kept_cells(grid, kept)


def actor_of(extract):
    colours = vtk.vtkDiscretizableColorTransferFunction()
    for angle, colour in COLOURS:
        colours.AddRGBPoint(angle, *colour)
    mapper = vtk.vtkDataSetMapper()
    mapper.SetInputConnection(extract.GetOutputPort())
    mapper.SetLookupTable(colours)
    mapper.SetScalarModeToUseCellData()
    mapper.UseLookupTableScalarRangeOn()
    actor = vtk.vtkActor()
    actor.SetMapper(mapper)
    properties = actor.GetProperty()
    properties.SetEdgeVisibility(True)
    properties.SetEdgeColor(.2, .2, .25)
    properties.SetLineWidth(.6)
    properties.SetAmbient(.25)
    return actor


def view(renderer, points, axis):
    centre = (points.min(0) + points.max(0)) / 2
    direction = np.array(DIRECTIONS[axis])
    camera = renderer.GetActiveCamera()
    camera.SetFocalPoint(*centre)
    camera.SetPosition(*(centre + 10 * direction))
    camera.SetViewUp(*((0, 0, 1) if axis == "y" else (0, 1, 0)))
    camera.ParallelProjectionOn()
    renderer.ResetCamera()
    camera.Zoom(1.2)
    renderer.ResetCameraClippingRange()


def draw(mesh, axis, position, command, picture):
    window = window_of(SIZE * len(WAYS), SIZE)
    with tempfile.TemporaryDirectory() as folder:
        for i, words in enumerate(WAYS):
            grid, points, tets = grid_of(mesh, words, command, folder)
            renderer = vtk.vtkRenderer()
            renderer.SetBackground(1, 1, 1)
            renderer.SetViewport(i / len(WAYS), 0, (i + 1) / len(WAYS), 1)
            renderer.AddActor(actor_of(one_side(grid, points, tets, "xyz".index(axis), position)))
            window.AddRenderer(renderer)
            view(renderer, points, axis)
            print(mesh, *words, len(tets), "tets", flush=True)
    save_png(window, picture)


def main():
    command, folder = sys.argv[1], pathlib.Path(sys.argv[2])
    for cut in sys.argv[3:]:
        mesh, axis, position = cut.rsplit(":", 2)
        draw(mesh, axis, float(position), command, folder / f"taper_{pathlib.Path(mesh).stem}.png")


if __name__ == "__main__":
    main()
