#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Draws six frames of the sample creature's walk: the posed shell, cut where its shape at rest is cut.

    xvfb-run -a python3 docs/scripts/pose_picture.py BUILD_FOLDER docs/measurements/images/walk.png

BUILD_FOLDER is that of a release build. Needs Debian's python3-vtk9 and xvfb.
"""
import pathlib
import subprocess
import sys
import tempfile

import vtk
from vtk.util.numpy_support import vtk_to_numpy

from vtk_pictures import kept_cells, read_grid, save_png, window_of

ROOT = pathlib.Path(__file__).resolve().parents[2]
BLUE, SAND, EDGE = (0.55, 0.70, 0.85), (0.93, 0.80, 0.62), (0.25, 0.25, 0.30)
FRAMES, SHOWN = 100, [1, 17, 33, 50, 67, 83]
CUT = 0.33  # through the left legs, at rest
SIZE = 420


def posed(build, folder):
    """The .vtu of each frame that is shown."""
    mesh, shell = ROOT / "samples/meshes/creature.obj", folder / "rest.vdb"
    subprocess.run([build / "src/vdb_shell", "build", "-q", mesh, "-o", shell], check=True)
    subprocess.run([build / "samples/make_motion", mesh, "walk", str(FRAMES), folder], check=True)
    for frame in SHOWN:
        out = folder / f"{frame}.vtu"
        # Where the skin crosses itself the status says so; the file is there.
        subprocess.run([build / "src/vdb_shell", "pose", "-q", shell, folder / f"walk.{frame:04d}.obj", "-o", out],
                       stderr=subprocess.DEVNULL)
        yield out


def kept_tets(path):
    grid = read_grid(path)
    rest = vtk_to_numpy(grid.GetPointData().GetArray("rest"))
    corners = vtk_to_numpy(grid.GetCells().GetConnectivityArray()).reshape(-1, 4)
    return kept_cells(grid, rest[corners][:, :, 0].mean(axis=1) < CUT).GetOutput()


def actor_of(grid):
    """Skin blue, inner faces and cut faces the colour of sand."""
    surface = vtk.vtkDataSetSurfaceFilter()
    surface.SetInputData(grid)
    surface.Update()
    faces = surface.GetOutput()
    layer = vtk_to_numpy(faces.GetPointData().GetArray("layer"))
    colours = vtk.vtkUnsignedCharArray()
    colours.SetNumberOfComponents(3)
    for i in range(faces.GetNumberOfCells()):
        ids = faces.GetCell(i).GetPointIds()
        skin = all(layer[ids.GetId(k)] == 0 for k in range(3))
        colours.InsertNextTuple3(*(int(255 * c) for c in (BLUE if skin else SAND)))
    faces.GetCellData().SetScalars(colours)
    mapper = vtk.vtkPolyDataMapper()
    mapper.SetInputData(faces)
    actor = vtk.vtkActor()
    actor.SetMapper(mapper)
    actor.GetProperty().SetEdgeVisibility(True)
    actor.GetProperty().SetEdgeColor(*EDGE)
    actor.GetProperty().SetLineWidth(0.4)
    return actor


def main():
    build, picture = pathlib.Path(sys.argv[1]), sys.argv[2]
    window = window_of(3 * SIZE, 2 * SIZE)
    with tempfile.TemporaryDirectory() as folder:
        for i, path in enumerate(posed(build, pathlib.Path(folder))):
            renderer = vtk.vtkRenderer()
            renderer.SetBackground(1, 1, 1)
            x, y = i % 3 / 3, .5 if i < 3 else 0
            renderer.SetViewport(x, y, x + 1 / 3, y + .5)
            renderer.AddActor(actor_of(kept_tets(path)))
            camera = renderer.GetActiveCamera()
            camera.SetPosition(4.2, 1.9, 2.2)
            camera.SetFocalPoint(0, .75, -.15)
            camera.SetViewUp(0, 1, 0)
            camera.SetViewAngle(34)
            renderer.ResetCameraClippingRange()
            window.AddRenderer(renderer)
    save_png(window, picture)


if __name__ == "__main__":
    main()
