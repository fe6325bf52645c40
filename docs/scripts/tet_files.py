# SPDX-License-Identifier: Apache-2.0
"""Points and tets of the files that this project and others write, and triangles of an .obj. Needs numpy; shares no
code with the library. Every reader gives (points as doubles, corners as integers from 0)."""
import base64
import pathlib
import re
import xml.etree.ElementTree

import numpy as np

from triangles import read_obj as read_triangles

VTK_TET, GMSH_TET = 10, 4
NUMPY_TYPES = {"Float32": "<f4", "Float64": "<f8", "Int32": "<i4", "UInt32": "<u4", "Int64": "<i8", "UInt64": "<u8",
               "UInt8": "u1", "Int8": "i1"}


def read_tets(path):
    """By extension: .vtu, .vtk, .msh (Gmsh 4.1), .node or .ele (TetGen)."""
    path = pathlib.Path(path)
    readers = {".vtu": read_vtu, ".vtk": read_vtk, ".msh": read_gmsh, ".node": read_tetgen, ".ele": read_tetgen}
    if path.suffix not in readers:
        raise ValueError(f"{path}: unknown extension; known are {' '.join(readers)}")
    points, tets = readers[path.suffix](path)
    if len(tets) and not (0 <= tets.min() and tets.max() < len(points)):
        raise ValueError(f"{path}: a corner from {tets.min()} to {tets.max()}, and {len(points)} points")
    return points, tets


def vtu_array(element, header):
    kind = np.dtype(NUMPY_TYPES[element.get("type")])
    if element.get("format") == "ascii":
        return np.array((element.text or "").split(), kind)
    if element.get("format") != "binary":
        raise ValueError(f'array {element.get("Name")}: format {element.get("format")} is not read')
    text = "".join(element.text.split())
    # The length is coded by itself, so that its last characters fill up a group of four.
    size = np.dtype(header).itemsize
    head = 4 * -(-size // 3)
    length = int(np.frombuffer(base64.b64decode(text[:head]), header, 1)[0])
    return np.frombuffer(base64.b64decode(text[head:]), kind, length // kind.itemsize)


def read_vtu(path):
    root = xml.etree.ElementTree.parse(path).getroot()
    if root.get("compressor"):
        raise ValueError(f"{path}: compressed arrays are not read")
    header = NUMPY_TYPES[root.get("header_type", "UInt32")]
    piece = root.find("UnstructuredGrid/Piece")
    cells = {one.get("Name"): vtu_array(one, header) for one in piece.find("Cells")}
    if (cells["types"] != VTK_TET).any():
        raise ValueError(f"{path}: has cells that are no tets")
    points = vtu_array(piece.find("Points/DataArray"), header)
    return points.reshape(-1, 3).astype(float), cells["connectivity"].reshape(-1, 4).astype(np.int64)


def read_vtk(path):
    """Legacy ASCII; cells that are no tets are left out."""
    text = path.read_text()
    points = re.search(r"^POINTS (\d+) \w+\n", text, re.MULTILINE)
    cells = re.search(r"^CELLS (\d+) (\d+)\n", text, re.MULTILINE)
    if not points or not cells:
        raise ValueError(f"{path}: no POINTS or no CELLS")
    where = np.fromstring(text[points.end():], sep=" ", count=3 * int(points[1]))
    flat = np.fromstring(text[cells.end():], dtype=np.int64, sep=" ", count=int(cells[2]))
    tets, at = [], 0
    while at < len(flat):
        if flat[at] == 4:
            tets.append(flat[at + 1:at + 5])
        at += flat[at] + 1
    return where.reshape(-1, 3), np.array(tets, np.int64).reshape(-1, 4)


def section(lines, name, path):
    try:
        return lines.index(f"${name}") + 1
    except ValueError:
        raise ValueError(f"{path}: no ${name}") from None


def read_gmsh(path):
    """Version 4.1, ASCII; elements that are no tets are left out."""
    lines = path.read_text().splitlines()
    if not lines[section(lines, "MeshFormat", path)].startswith("4.1 0"):
        raise ValueError(f"{path}: not version 4.1 in ASCII")
    at = section(lines, "Nodes", path)
    blocks, count, _, largest = map(int, lines[at].split())
    index, points, at = np.full(largest + 1, -1), np.empty((count, 3)), at + 1
    done = 0
    for _ in range(blocks):
        many = int(lines[at].split()[3])
        index[[int(tag) for tag in lines[at + 1:at + 1 + many]]] = np.arange(done, done + many)
        for i, line in enumerate(lines[at + 1 + many:at + 1 + 2 * many]):
            points[done + i] = [float(word) for word in line.split()[:3]]
        done, at = done + many, at + 1 + 2 * many
    at = section(lines, "Elements", path)
    blocks, at, tets = int(lines[at].split()[0]), at + 1, []
    for _ in range(blocks):
        _, _, kind, many = map(int, lines[at].split())
        if kind == GMSH_TET:
            tets += [[int(word) for word in line.split()[1:5]] for line in lines[at + 1:at + 1 + many]]
        at += 1 + many
    return points, index[np.array(tets, np.int64).reshape(-1, 4)]


def tetgen_rows(path):
    rows = [line.split() for line in path.read_text().splitlines() if line.strip() and not line.startswith("#")]
    count = int(rows[0][0])
    if len(rows) < count + 1:
        raise ValueError(f"{path}: {len(rows) - 1} rows, {count} stated")
    return rows[1:count + 1]


def read_tetgen(path):
    nodes = tetgen_rows(path.with_suffix(".node"))
    points = np.array([[float(word) for word in row[1:4]] for row in nodes])
    tets = np.array([[int(word) for word in row[1:5]] for row in tetgen_rows(path.with_suffix(".ele"))], np.int64)
    return points, tets.reshape(-1, 4) - int(nodes[0][0])


def read_obj(path):
    """Float32 points, equal ones welded, and triangles; polygons become fans. What the tools of all rows are given."""
    points, triangles = read_triangles(path)
    # A sum with zero, because -0 and 0 are one place.
    welded, first, index = np.unique(np.array(points, np.float32) + np.float32(0), axis=0, return_index=True,
                                     return_inverse=True)
    triangles = index.reshape(-1)[np.array(triangles, np.int64)]
    # In the order of the file, so that others see the surface as its author numbered it.
    order = np.argsort(first)
    rank = np.empty(len(order), np.int64)
    rank[order] = np.arange(len(order))
    return welded[order].astype(float), rank[triangles]
