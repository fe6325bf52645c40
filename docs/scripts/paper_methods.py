#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Builds every mesh of a folder with the paper's methods and writes the table of docs/measurements/paper_methods.md.

    paper_methods.py COMMAND MESH_FOLDER OUTPUT.md

COMMAND is the vdb_shell binary. Meshes that the command refuses are listed with its message.
"""
import json
import pathlib
import subprocess
import sys
import tempfile

from runs import replace_tables, table

METHODS = [
    ("raw, rho 0.9", ["--stop-test", "normal", "--rho", "0.9"]),
    ("relative test, rho 0.9", ["--stop-test", "relative-normal", "--rho", "0.9"]),
    ("raw with the adaptive limit", ["--stop-test", "normal", "--rho", "0.9", "--limit", "adaptive"]),
]
NOT_VALID = 7  # what `build` ends with when it has written a shell that overlaps or has inverted tets
STAGES = ["read", "level set", "line stepping", "tets", "coverage"]


def build(command, mesh, flags):
    with tempfile.TemporaryDirectory() as folder:
        report = pathlib.Path(folder) / "report.json"
        run = subprocess.run([command, "build", "-q", str(mesh), "--method", "raw", "--resolution", "256",
                              "--report", str(report)] + flags, capture_output=True, text=True)
        if run.returncode not in (0, NOT_VALID):
            return run.stderr.strip()
        return json.loads(report.read_text())


def row(name, report):
    vertices = report["mesh"]["points"]
    stuck = report["lines"]["stuck_vertices"]
    tets = report["tets"]["tets"]
    seconds = {stage["stage"]: stage["seconds"] for stage in report["stages"]}
    cells = [name, str(report["mesh"]["triangles"]), f"{100 * stuck / vertices:.0f}",
             f"{report['volume']['fill']:.3f}", f"{report['tets']['inverted']}",
             f"{100 * report['tets']['inverted'] / max(tets, 1):.1f}",
             f"{report['coverage']['covered_share']:.3f}", f"{100 * report['coverage']['overlap_share']:.2f}"]
    return cells + [f"{seconds.get(stage, 0):.2f}" for stage in STAGES]


def measure(command, meshes, root, flags):
    head = ["mesh", "faces", "stuck %", "fill", "inverted", "inverted %", "covered", "covered twice %"] + \
           [f"{stage} s" for stage in STAGES]
    rows, refused = [], []
    for mesh in meshes:
        name = str(mesh.relative_to(root).with_suffix(""))
        report = build(command, mesh, flags)
        if isinstance(report, str):
            refused.append(f"- `{name}`: {report}")
        else:
            rows.append(row(name, report))
    return table(head, rows), refused


def main():
    command, folder, output = sys.argv[1], pathlib.Path(sys.argv[2]), pathlib.Path(sys.argv[3])
    meshes = sorted(folder.glob("*/*.obj"), key=lambda mesh: (mesh.parent.name != "paper", mesh.stat().st_size))
    text = []
    for title, flags in METHODS:
        lines, refused = measure(command, meshes, folder, flags)
        text += [f"### {title}", "", "`vdb_shell build MESH --method raw --resolution 256 " + " ".join(flags) + "`", "", *lines, ""]
    text += ["### Refused", "", *refused]
    replace_tables(output, text)


if __name__ == "__main__":
    main()
