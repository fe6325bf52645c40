#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""What `build --mend` makes of faulty surfaces, for docs/measurements/mended.md.

    mended.py COMMAND docs/measurements/mended.md FOLDER ...

Takes each .obj and .off in the folders that `inspect` does not find usable as it is; of several of one name and size, the
first.
Each build is one run on one thread.
"""
import argparse
import collections
import pathlib
import subprocess

from halves import half_of
from runs import build, replace_tables, table

CHECK_FAILED = 7


def arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("command")
    parser.add_argument("page", type=pathlib.Path)
    parser.add_argument("folders", type=pathlib.Path, nargs="+")
    return parser.parse_args()


def faulty(command, folders):
    meshes = {}
    for folder in folders:
        for mesh in sorted([*folder.glob("*.obj"), *folder.glob("*.off")]):
            meshes.setdefault((mesh.stem, mesh.stat().st_size), mesh)
    # A placeholder without triangles is no mesh; inspect says so with the status of reading.
    return [mesh for mesh in meshes.values()
            if subprocess.run([command, "inspect", mesh], capture_output=True).returncode == CHECK_FAILED]


def figures(report):
    repair, wrap = report["repair"], report["wrap"]
    return {"mend": report["mend"], "certified": report["certificate"]["certified"], "fill": report["volume"]["fill"],
            "triangles": report["mesh"]["triangles"], "kept": repair["kept_triangles"] if repair else 0,
            "read": report["read"]["file_faces"], "farthest": wrap["input_to_wrap"]["max"] / wrap["voxel_size"] if wrap else None}


def row(mesh, done):
    if done["exit"] != 0:
        return [mesh.stem, half_of(mesh.stem), f"exit {done['exit']}", *[""] * 7]
    *refused, taken = done["mend"]
    return [mesh.stem, half_of(mesh.stem), f"{done['read']:,}", refused[0]["refusal"], taken["tried"],
            refused[-1]["refusal"] if len(refused) > 1 else "", f"{done['triangles']:,}",
            f"{done['kept']:,} kept" if done["farthest"] is None else f"farthest {done['farthest']:.1f}",
            f"{done['fill']:.4f}" + ("" if done["certified"] else ", NOT certified"), f"{done['seconds']:.1f}"]


def main():
    a = arguments()
    rows, taken = [], collections.Counter()
    for mesh in faulty(a.command, a.folders):
        done = build(a.command, mesh, ["--mend"], figures)
        taken[done["mend"][-1]["tried"] if done["exit"] == 0 else "nothing"] += 1
        rows.append(row(mesh, done))
        print(" | ".join(rows[-1]), flush=True)
    head = ["mesh", "half", "faces", "in the way", "taken", "less was not enough", "triangles", "", "fill", "s"]
    sums = ", ".join(f"{name} {count}" for name, count in taken.most_common())
    replace_tables(a.page, [f"{len(rows)} faulty surfaces; taken: {sums}.", "", *table(head, rows)])


if __name__ == "__main__":
    main()
