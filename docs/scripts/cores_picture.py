#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""A shell with cores, cut open: docs/images/skin_and_bones.png. Needs Debian's python3-vtk9 and xvfb.

    xvfb-run -a python3 docs/scripts/cores_picture.py SHELL.vtu CORES.obj PICTURE.png [X]

SHELL.vtu is what `vdb_shell build --core CORES.obj -o SHELL.vtu` wrote. What of the tets lies beyond the plane
at X (0.05) is taken away; the cores stay whole. Tets are coloured by the number of their prism.
"""
import sys

import vtk

from vtk_pictures import read_grid, save_png, window_of


def actor(mapper, colour=None):
    made = vtk.vtkActor()
    made.SetMapper(mapper)
    if colour:
        made.GetProperty().SetColor(*colour)
    made.GetProperty().SetAmbient(0.35)
    made.GetProperty().SetDiffuse(0.7)
    return made


def cut_tets(name, x):
    plane = vtk.vtkPlane()
    plane.SetOrigin(x, 0, 0)
    plane.SetNormal(-1, 0, 0)
    clip = vtk.vtkTableBasedClipDataSet()
    clip.SetInputData(read_grid(name))
    clip.SetClipFunction(plane)
    surface = vtk.vtkDataSetSurfaceFilter()
    surface.SetInputConnection(clip.GetOutputPort())
    surface.Update()
    # Colours that differ between neighbours, and mean nothing else.
    prism = surface.GetOutput().GetCellData().GetArray("prism")
    shade = vtk.vtkFloatArray()
    shade.SetName("shade")
    for i in range(prism.GetNumberOfTuples()):
        shade.InsertNextValue(prism.GetValue(i) * 7 % 11 / 10)
    surface.GetOutput().GetCellData().SetScalars(shade)
    table = vtk.vtkLookupTable()
    table.SetHueRange(0.02, 0.11)
    table.SetSaturationRange(0.45, 0.6)
    table.SetValueRange(0.8, 1.0)
    table.Build()
    mapper = vtk.vtkDataSetMapper()
    mapper.SetInputData(surface.GetOutput())
    mapper.SetLookupTable(table)
    made = actor(mapper)
    made.GetProperty().EdgeVisibilityOn()
    made.GetProperty().SetEdgeColor(0.35, 0.2, 0.15)
    made.GetProperty().SetLineWidth(0.6)
    return made


def bones(name):
    reader = vtk.vtkOBJReader()
    reader.SetFileName(name)
    mapper = vtk.vtkPolyDataMapper()
    mapper.SetInputConnection(reader.GetOutputPort())
    return actor(mapper, (0.93, 0.92, 0.86))


def main():
    shell, cores, picture = sys.argv[1:4]
    x = float(sys.argv[4]) if len(sys.argv) > 4 else 0.05
    renderer = vtk.vtkRenderer()
    renderer.SetBackground(1, 1, 1)
    renderer.AddActor(cut_tets(shell, x))
    renderer.AddActor(bones(cores))
    camera = renderer.GetActiveCamera()
    camera.SetPosition(4, 1.6, 1.4)
    camera.SetFocalPoint(0, 0.75, 0)
    camera.SetViewUp(0, 1, 0)
    renderer.ResetCamera()
    camera.Zoom(1.5)
    window = window_of(1100, 800)
    window.AddRenderer(renderer)
    save_png(window, picture)


if __name__ == "__main__":
    main()
