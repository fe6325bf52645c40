# SPDX-License-Identifier: Apache-2.0
"""What the scripts that draw with VTK share: reading tets, keeping some of them, an empty window, saving it."""
import numpy as np
import vtk
from vtk.util.numpy_support import numpy_to_vtk


def read_grid(path):
    reader = vtk.vtkXMLUnstructuredGridReader()
    reader.SetFileName(str(path))
    reader.Update()
    return reader.GetOutput()


def kept_cells(grid, kept):
    """The filter that gives the cells where `kept`, an array of truth values, holds."""
    node = vtk.vtkSelectionNode()
    node.SetFieldType(vtk.vtkSelectionNode.CELL)
    node.SetContentType(vtk.vtkSelectionNode.INDICES)
    node.SetSelectionList(numpy_to_vtk(np.flatnonzero(kept).astype(np.int64), deep=True, array_type=vtk.VTK_ID_TYPE))
    selection = vtk.vtkSelection()
    selection.AddNode(node)
    extract = vtk.vtkExtractSelection()
    extract.SetInputData(0, grid)
    extract.SetInputData(1, selection)
    extract.Update()
    return extract


def window_of(width, height):
    window = vtk.vtkRenderWindow()
    window.SetOffScreenRendering(True)
    window.SetMultiSamples(8)
    window.SetSize(width, height)
    return window


def save_png(window, path):
    window.Render()
    image = vtk.vtkWindowToImageFilter()
    image.SetInput(window)
    image.ReadFrontBufferOff()
    writer = vtk.vtkPNGWriter()
    writer.SetFileName(str(path))
    writer.SetInputConnection(image.GetOutputPort())
    writer.Write()
