#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Opens files that vdb_shell wrote with other people's programs and prints what each reports.

    open_outputs.py [--with PROGRAM] FILE...

Volumes (.vdb) are opened by pyopenvdb (`openvdb` from 12 on) and vdb_print, .vtu by VTK, .msh and
.mesh by gmsh. A program that is not there is named and left out; --with takes one of them only, so
that a test of its own tells of each whether it was there. Exit status: 0 when all that were there
opened their files, 1 when one did not or none had a file to open, 77 when none was there.
"""

import os
import shutil
import subprocess
import sys
import tempfile

PROGRAMS = ("pyopenvdb", "vdb_print", "VTK", "gmsh")
opened, failed, missing = [], [], []


def report(program, path, text, ok=True):
    (opened if ok else failed).append((program, path))
    print(f"{program}: {os.path.basename(path)}: {'' if ok else 'FAILED: '}{text}")


def absent(program, path):
    missing.append(program)
    print(f"{program}: not there, {os.path.basename(path)} not tried")


def import_openvdb():
    for name in ("openvdb", "pyopenvdb"):
        try:
            return __import__(name)
        except ImportError:
            pass
    return None


def open_volumes(path):
    vdb = import_openvdb()
    if vdb is None:
        return absent("pyopenvdb", path)
    metadata = vdb.readMetadata(path)
    points_file = metadata.get("vdb_shell_points_file")
    report("pyopenvdb", path, f"readMetadata: schema {metadata.get('vdb_shell_schema')}, "
           f"{metadata.get('vdb_shell_tets')} tets")
    if points_file != os.path.basename(path):
        for name in ("surface", "depth"):
            grid = vdb.read(path, name)
            half = ", saved as half" if grid.saveFloatAsHalf else ""
            report("pyopenvdb", path, f"read({name!r}): {grid.gridClass}, "
                   f"{grid.activeVoxelCount()} active voxels{half}", grid.activeVoxelCount() > 0)
    for call in ("readAllGridMetadata", "readAll"):
        try:
            result = getattr(vdb, call)(path)
            grids = result[0] if isinstance(result, tuple) else result
            report("pyopenvdb", path, f"{call}: " + ", ".join(g.name for g in grids))
        except TypeError as error:
            # Known: one point grid in a file is enough. Only a file that keeps its points beside
            # it promises that this works.
            promised = bool(points_file) and points_file != os.path.basename(path)
            report("pyopenvdb", path, f"{call}: {error}", ok=not promised)


def run(program, path, arguments, wanted):
    if shutil.which(program) is None:
        return absent(program, path)
    result = subprocess.run([program, *arguments], capture_output=True, text=True, timeout=300)
    text = result.stdout + result.stderr
    good = result.returncode == 0 and wanted in text and "Error" not in text
    lines = [line.strip() for line in text.splitlines() if wanted in line]
    report(program, path, "; ".join(lines) or text.strip()[-400:], good)


def open_vtk(path):
    try:
        from vtk import vtkXMLUnstructuredGridReader
    except ImportError:
        return absent("VTK", path)
    reader = vtkXMLUnstructuredGridReader()
    reader.SetFileName(path)
    reader.Update()
    grid = reader.GetOutput()
    arrays = [data.GetArrayName(i) for data in (grid.GetPointData(), grid.GetCellData())
              for i in range(data.GetNumberOfArrays())]
    kinds = {grid.GetCellType(i) for i in range(grid.GetNumberOfCells())}
    good = grid.GetNumberOfCells() > 0 and kinds == {10}
    report("VTK", path, f"{grid.GetNumberOfPoints()} points, {grid.GetNumberOfCells()} cells of "
           f"types {sorted(kinds)}, arrays {', '.join(arrays)}", good)


def open_file(path, programs):
    extension = os.path.splitext(path)[1].lower()
    if extension not in (".vdb", ".vtu", ".msh", ".mesh"):
        print(f"nothing here opens {path}")
    if extension == ".vdb" and "pyopenvdb" in programs:
        open_volumes(path)
    if extension == ".vdb" and "vdb_print" in programs:
        run("vdb_print", path, [path], " ")
    if extension == ".vtu" and "VTK" in programs:
        open_vtk(path)
    if extension in (".msh", ".mesh") and "gmsh" in programs:
        run("gmsh", path, [path, "-check"], "nodes")


def main():
    paths, programs = sys.argv[1:], PROGRAMS
    if paths[:1] == ["--with"]:
        programs, paths = paths[1:2], paths[2:]
        if programs[0] not in PROGRAMS:
            sys.exit(f"open_outputs.py: {programs[0]} is none of {', '.join(PROGRAMS)}")
    if len(paths) == 2 and paths[0] == "--make-with":
        # For ctest: the command makes the files of a small shell first.
        with tempfile.TemporaryDirectory() as folder:
            names = [os.path.join(folder, "shell" + e) for e in (".vdb", ".vtu", ".msh", ".mesh")]
            outputs = [word for name in names for word in ("-o", name)]
            subprocess.run([*paths[1].split(";"), *outputs], check=True, capture_output=True)
            command, half = paths[1].split(";")[0], os.path.join(folder, "half.vdb")
            subprocess.run([command, "convert", names[0], "--half", "--points", "beside", "-o", half],
                           check=True, capture_output=True)
            for name in [*names, half, os.path.join(folder, "half.points.vdb")]:
                open_file(name, programs)
    else:
        for path in paths:
            open_file(path, programs)
    if failed:
        return 1
    if opened:
        return 0
    return 77 if missing else 1


if __name__ == "__main__":
    sys.exit(main())
