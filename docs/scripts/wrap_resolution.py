#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Wraps with voxels as long as the mean edge, beside those with 128 along the longest side, for docs/measurements/wrap.md.

    wrap_resolution.py COMMAND docs/measurements/wrap.md [PREFIX=]MESH ...

Each mesh is built with --wrap twice on one thread. A prefix is put before the mesh's name, as in the lists of halves.
"""
import argparse
import pathlib

from halves import half_of
from runs import build, replace_tables, table

LEAST = 128
HEAD = ["mesh", "half", "triangles", "voxels along", "of the wrap", "input to wrap, mean", "wrap to input, mean", "fill", "s"]


def figures(report):
    wrap = report["wrap"]
    return {"voxel": wrap["voxel_size"], "read": report["read"]["file_faces"], "triangles": report["mesh"]["triangles"],
            "fill": report["volume"]["fill"], "distances": [wrap[way]["mean"] for way in ("input_to_wrap", "wrap_to_input")]}


def row(name, done, unit):
    return [name, half_of(name), f"{done['read']:,}", f"{LEAST * unit / done['voxel']:.0f}", f"{done['triangles']:,}",
            *[f"{distance / unit:.3f}" for distance in done["distances"]], f"{done['fill']:.4f}", f"{done['seconds']:.1f}"]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("command")
    parser.add_argument("page", type=pathlib.Path)
    parser.add_argument("meshes", nargs="+")
    a = parser.parse_args()
    rows = []
    for named in a.meshes:
        prefix, _, mesh = named.rpartition("=")
        coarse, fine = [build(a.command, mesh, ["--wrap", *flags], figures)
                        for flags in (["--wrap-resolution", str(LEAST)], [])]
        for done in (coarse, fine):
            rows.append(row(prefix + pathlib.Path(mesh).stem, done, coarse["voxel"]))
            print(" | ".join(rows[-1]), flush=True)
    replace_tables(a.page, table(HEAD, rows), "resolution")


if __name__ == "__main__":
    main()
