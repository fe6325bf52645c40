# SPDX-License-Identifier: Apache-2.0
"""Tets of one surface by this project's command, by TetGen and by gmsh, kept in a folder so that each is made once.
Needs numpy."""
import hashlib
import pathlib
import re
import shutil
import subprocess
import tempfile

import numpy as np

from tet_files import read_obj
from tet_shapes import enclosed_volume

TETGEN = {"TetGen -pY": ["-pY"], "TetGen -pYq1.414/14": ["-pYq1.414/14"]}
GMSH = {"gmsh -3 -optimize": ["-3", "-optimize"]}


def add_arguments(parser, ours, seconds, meshes=True):
    """The arguments of a script that compares tets: `ours` are its default columns, `seconds` its default limit."""
    parser.add_argument("--ours", nargs="+", default=ours, metavar="NAME=OPTIONS")
    if meshes:
        parser.add_argument("--meshes", type=pathlib.Path,
                            default=pathlib.Path(__file__).parent.parent / "measurements/shape_meshes.txt")
        parser.add_argument("--only", nargs="+", help="names of the list; the others are left out")
    parser.add_argument("--cache", default=pathlib.Path(tempfile.gettempdir()) / "vdb_shell_tets")
    parser.add_argument("--seconds", type=float, default=seconds, help="what one run of a program may take")


class Failed(Exception):
    """Why a program left no tets, in a few words."""


class Maker:
    """`command` is the vdb_shell binary, `cache` the folder, `seconds` what one run may take."""

    def __init__(self, command, cache, seconds):
        self.command, self.cache, self.seconds = command, pathlib.Path(cache), seconds

    def ours(self, mesh, options, extension=".vtu"):
        # Another binary or another surface makes other tets, so both are part of the name.
        key = self.folder(mesh, "vdb_shell", digest(self.command) + " ".join(options))
        out = key / f"shell{extension}"
        arguments = [str(self.command), "build", "-q", *options, str(mesh), "-o", out.name,
                     "--report", f"shell{extension}.json"]
        return self.once(out, arguments), key / f"shell{extension}.json"

    def others(self, mesh, name):
        """The file of tets by `name`, one of TETGEN and GMSH."""
        key = self.folder(mesh, name.split()[0], name)
        if name in TETGEN:
            if not (key / "surface.smesh").exists():
                write_smesh(key / "surface.smesh", *read_obj(mesh))
            return self.once(key / "surface.1.node", ["tetgen", *TETGEN[name], "surface.smesh"])
        if not (key / "surface.msh").exists():
            write_gmsh_surface(key / "surface.msh", *read_obj(mesh))
        return self.once(key / "solid.msh", ["gmsh", *GMSH[name], "surface.geo", "-o", "solid.msh"])

    def folder(self, mesh, program, words):
        what = hashlib.sha256((digest(mesh) + words).encode()).hexdigest()[:16]
        key = self.cache / f"{pathlib.Path(mesh).stem}-{program}-{what}"
        key.mkdir(parents=True, exist_ok=True)
        return key

    def once(self, out, arguments):
        failure = out.parent / f"{out.name}.failed"
        if out.exists():
            return out
        if failure.exists():
            raise Failed(failure.read_text())
        if shutil.which(arguments[0]) is None:
            raise Failed("not installed")
        why, printed = self.run(arguments, out.parent)
        if not why and not out.exists():
            why = "no result"
        if why:
            out.unlink(missing_ok=True)
            failure.write_text(f"{why}{message_of(printed)}")
            raise Failed(failure.read_text())
        return out

    def run(self, arguments, folder):
        try:
            done = subprocess.run(arguments, cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
                                  errors="replace", timeout=self.seconds)
        except subprocess.TimeoutExpired:
            return f"over {self.seconds:g} s", ""
        if done.returncode:
            return f"exit {done.returncode}", done.stdout
        # gmsh says so and leaves with status 0 all the same.
        return ("error" if re.search(r"^Error\s*:", done.stdout, re.MULTILINE) else None), done.stdout


def digest(path):
    return hashlib.sha256(pathlib.Path(path).read_bytes()).hexdigest()


def message_of(printed):
    """The line that tells why, if there is one."""
    found = re.search(r"^.*\b(?:[Ee]rror|[Ii]nvalid|PLC|intersect|No )\b.*$", printed, re.MULTILINE)
    return f": {found[0].strip()[:90]}" if found else ""


def numbers(row):
    return " ".join(repr(float(x)) for x in row)


def components(triangles):
    """Of each triangle the number of its component."""
    label = np.arange(triangles.max() + 1)
    while True:
        least = label[triangles].min(1)
        before = label.copy()
        for k in range(3):
            np.minimum.at(label, triangles[:, k], least)
        label = label[label]
        if (label == before).all():
            return np.unique(label[triangles[:, 0]], return_inverse=True)[1]


def point_in_cavity(points, triangles, first):
    """From the middle of a triangle half way along its normal to whatever comes next."""
    a, b, c = (points[triangles[:, k]] for k in range(3))
    start = points[triangles[first]].mean(0)
    along = np.cross(b[first] - a[first], c[first] - a[first])
    u, v, to = b - a, c - a, start - a
    cross = np.cross(along, v)
    with np.errstate(divide="ignore", invalid="ignore"):
        inverse = 1 / np.einsum("ij,ij->i", cross, u)
        across = np.einsum("ij,ij->i", to, cross) * inverse
        turned = np.cross(to, u)
        up, far = turned @ along * inverse, np.einsum("ij,ij->i", v, turned) * inverse
        inside = (across >= 0) & (up >= 0) & (across + up <= 1)
    hit = inside & (far > 0) & (np.arange(len(triangles)) != first)
    return start + along * far[hit].min() / 2


def cavities(points, triangles):
    """A point in each component that is turned inside out."""
    label = components(triangles)
    parts = [np.flatnonzero(label == k) for k in range(label.max() + 1)]
    return [point_in_cavity(points, triangles, part[0]) for part in parts
            if enclosed_volume(points, triangles[part]) < 0]


def write_smesh(path, points, triangles):
    holes = cavities(points, triangles)
    lines = [f"{len(points)} 3 0 0", *(f"{i} {numbers(p)}" for i, p in enumerate(points)), f"{len(triangles)} 0",
             *("3 " + " ".join(map(str, t)) for t in triangles.tolist()),
             str(len(holes)), *(f"{i} {numbers(p)}" for i, p in enumerate(holes)), "0"]
    path.write_text("\n".join(lines) + "\n")


def write_gmsh_surface(path, points, triangles):
    """A discrete surface a component, whose triangles gmsh keeps; beside it the .geo with the volume between them."""
    label = components(triangles)
    low, high = numbers(points.min(0)), numbers(points.max(0))
    parts = range(label.max() + 1)
    entities, nodes, elements = [f"0 0 {len(parts)} 0"], [], []
    for part in parts:
        mine = np.flatnonzero(label == part)
        used = np.unique(triangles[mine])
        entities.append(f"{part + 1} {low} {high} 0 0")
        nodes += [f"2 {part + 1} 0 {len(used)}", *(str(i + 1) for i in used), *map(numbers, points[used])]
        elements += [f"2 {part + 1} 2 {len(mine)}",
                     *(f"{i + 1} " + " ".join(str(c + 1) for c in triangles[i]) for i in mine)]
    counts = [f"{len(parts)} {n} 1 {n}" for n in (len(points), len(triangles))]
    sections = {"MeshFormat": ["4.1 0 8"], "Entities": entities, "Nodes": [counts[0], *nodes],
                "Elements": [counts[1], *elements]}
    path.write_text("".join(f"${name}\n" + "\n".join(lines) + f"\n$End{name}\n" for name, lines in sections.items()))
    loops = "".join(f"Surface Loop({part + 1}) = {{{part + 1}}};\n" for part in parts)
    # Tets of the volume alone, in the one version that tet_files.py reads.
    path.with_suffix(".geo").write_text(
        f'Merge "{path.name}";\n{loops}Volume(1) = {{{", ".join(str(part + 1) for part in parts)}}};\n'
        "Physical Volume(1) = {1};\nMesh.MshFileVersion = 4.1;\n")
