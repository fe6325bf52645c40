#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Times texture volumes that are mapped into shells, for docs/measurements/volumes.md.

    map_figures.py BUILD_FOLDER MESH_FOLDER docs/measurements/volumes.md

BUILD_FOLDER is that of a release build with -DVDB_SHELL_BENCHMARKS=ON. Every surface is built with the defaults and measured by map_probe.
"""
import argparse
import json
import pathlib
import subprocess
import tempfile

from runs import replace_tables, table
from volume_meshes import JUDGING, TUNING, half, path


def measure(options, name, folder):
    mesh = path(options.meshes, name)
    shell = folder / "shell.vdb"
    subprocess.run([options.build / "src/vdb_shell", "build", "-q", mesh, "-o", shell], check=True)
    text = subprocess.run([options.build / "tests/map_probe", shell], check=True, capture_output=True, text=True).stdout
    return {"name": name, **json.loads(text)}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build", type=pathlib.Path)
    parser.add_argument("meshes", type=pathlib.Path)
    parser.add_argument("page", type=pathlib.Path)
    options = parser.parse_args()
    results = []
    for name in TUNING + JUDGING:
        with tempfile.TemporaryDirectory() as folder:
            results.append(measure(options, name, pathlib.Path(folder)))
    rows = [[r["name"].split("/")[-1], half(r["name"]), str(r["voxels"]), f"{r['ratio_single']:.2f}",
             f"{r['ratio_filtered']:.2f}", f"{100 * r['limited_samples'] / r['voxels']:.2f}", f"{r['seconds']:.2f}"] for r in results]
    head = ["mesh", "half", "voxels", "one sample", "filtered", "limited samples, %", "seconds, filtered"]
    replace_tables(options.page, table(head, rows), "map")


main()
