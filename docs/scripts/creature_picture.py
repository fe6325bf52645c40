#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Draws the README's picture: the sample creature, and its shell with one side cut away.

    xvfb-run -a python3 docs/scripts/creature_picture.py COMMAND samples/meshes/creature.obj docs/images/creature.png

Needs Debian's python3-vtk9 and xvfb.
"""
import pathlib
import subprocess
import sys
import tempfile

import vtk

from vtk_pictures import read_grid, save_png, window_of

command, mesh, picture = sys.argv[1:4]
BLUE, SAND, EDGE = (0.55, 0.70, 0.85), (0.93, 0.80, 0.62), (0.25, 0.25, 0.30)


def tets_of(folder):
    path = str(pathlib.Path(folder) / "creature.vtu")
    subprocess.run([command, "build", mesh, "-q", "--resolution", "64", "--samples", "0", "-o", path], check=True)
    return read_grid(path)


def actor_of(port, colour, edges):
    mapper = vtk.vtkDataSetMapper()
    mapper.SetInputConnection(port)
    mapper.ScalarVisibilityOff()
    actor = vtk.vtkActor()
    actor.SetMapper(mapper)
    properties = actor.GetProperty()
    properties.SetColor(*colour)
    properties.SetEdgeVisibility(edges)
    properties.SetEdgeColor(*EDGE)
    properties.SetLineWidth(0.6)
    return actor


def cut_away(tets, origin, normal):
    plane = vtk.vtkPlane()
    plane.SetOrigin(*origin)
    plane.SetNormal(*normal)
    clip = vtk.vtkTableBasedClipDataSet()
    clip.SetInputData(tets)
    clip.SetClipFunction(plane)
    clip.InsideOutOn()
    clip.Update()
    return clip


def view(renderer, bounds, direction):
    centre = [(bounds[2 * i] + bounds[2 * i + 1]) / 2 for i in range(3)]
    camera = renderer.GetActiveCamera()
    camera.SetFocalPoint(*centre)
    camera.SetPosition(*[c + 10 * d for c, d in zip(centre, direction)])
    camera.SetViewUp(0, 1, 0)
    renderer.ResetCamera(bounds)
    camera.Zoom(1.3)


def main():
    with tempfile.TemporaryDirectory() as folder:
        tets = tets_of(folder)
    surface = vtk.vtkDataSetSurfaceFilter()
    surface.SetInputData(tets)
    half = cut_away(tets, (0.0, 0.0, 0.0), (1, 0, 0))
    window = window_of(1400, 700)
    for left, actor in ((0.0, actor_of(surface.GetOutputPort(), BLUE, False)), (0.5, actor_of(half.GetOutputPort(), SAND, True))):
        renderer = vtk.vtkRenderer()
        renderer.SetViewport(left, 0, left + 0.5, 1)
        renderer.SetBackground(1, 1, 1)
        renderer.AddActor(actor)
        window.AddRenderer(renderer)
        view(renderer, tets.GetBounds(), (0.9, 0.25, 0.45))
    save_png(window, picture)


main()
