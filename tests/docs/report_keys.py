#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The tables of report keys in docs/file_format.md are the keys that `vdb_shell build --report` writes.

    report_keys.py COMMAND FOLDER

COMMAND is the program, FOLDER that of the project. Builds shells of small surfaces, so that together
the reports have all parts, and collects the keys of every object by its path: "refine.rounds[]" are
the entries of that list. Each row "| `path` | keys | ... |" of the section "Report (JSON)" has to name
all keys that were found under that path, and no others, in the order of the reports. An object
without a row of its path is as the row of the end of its path tells, or one of the shapes of the
second table.
Each report is also held against docs/schema/report.schema.json, and the page has to say its schema's number.
Prints what differs and ends with status 1, or says how many keys were compared.
"""
import json
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

import json_schema

BOTH_SIDES = ["--side", "both", "--layers", "2", "--thickness-scale", "0.5"]
# Without either program no report has figures of a filled core.
FILLER = next(filter(shutil.which, ["tetgen", "gmsh"]), None)

BOUND_NOT_MET, CHECK_FAILED = 6, 7  # of the raw method

# There only where a number is not the whole count, which takes thousands of triangles in one place.
RARE = {"self_intersections_at_least", "crossings_at_least"}


def surfaces(samples, folder):
    """Of the sample box: with a hole, with a copy that crosses it, and small."""
    box = (samples / "box.obj").read_text().splitlines()
    points = [line for line in box if line.startswith("v ")]
    faces = [line for line in box if line.startswith("f ")]
    moved = ["v " + " ".join(str(float(x) + 0.3) for x in line.split()[1:4]) for line in points]
    shifted = [re.sub(r"(?<=\s)(\d+)(/\S*)?", lambda m: str(int(m[1]) + len(points)), line) for line in faces]
    (folder / "open.obj").write_text("\n".join(points + faces[1:]) + "\n")
    small = ["v " + " ".join(str(float(x) * 0.3) for x in line.split()[1:4]) for line in points]
    (folder / "core.obj").write_text("\n".join(small + faces) + "\n")
    (folder / "crossing.obj").write_text("\n".join(points + moved + faces + shifted) + "\n")


def reports(command, samples, folder):
    surfaces(samples, folder)
    box = samples / "box.obj"
    for number, (surface, *options) in enumerate([
            [box, *BOTH_SIDES],
            [folder / "open.obj", "--mend"],
            [samples / "torus.obj", "--wrap", "--wrap-resolution", "32"],
            [samples / "sphere.obj", "--decimate-to", "200", "--refine-rounds", "1"],
            [samples / "torus.obj", "--method", "raw"],
            [samples / "torus.obj", "--method", "raw", "--side", "both", "--thickness", "0.05"],
            [samples / "torus.obj", "--side", "both", "--thickness", "0.05", "--samples", "0"],
            [box, "--retriangulate", "--subdivide", "1", "--want-amips", "3.01"],
            [samples / "sphere.obj", "--core", folder / "core.obj"],
            [samples / "torus.obj", "--remesh-to", "1000", "--taper"],
            *[[samples / "sphere.obj", "--thickness-scale", "0.5", "--core-fill", FILLER]] * bool(FILLER),
            [folder / "crossing.obj", "--allow-self-intersections"],
            [folder / "0.vdb"]]):
        out = folder / f"{number}.json"
        done = subprocess.run([command, "build", surface, "--resolution", "24", "-q", *options,
                               "--report", out, "-o", folder / f"{number}.vdb"])
        if done.returncode not in (0, BOUND_NOT_MET, CHECK_FAILED):
            done.check_returncode()
        yield json.loads(out.read_text())
    posed = folder / "posed.json"
    subprocess.run([command, "pose", folder / "0.vdb", box, "-q", "--report", posed], check=True)
    yield json.loads(posed.read_text())


def collect(value, path, found):
    """Adds the keys of all objects below, each list of keys as it was met."""
    if isinstance(value, list):
        for entry in value:
            collect(entry, path + "[]", found)
    elif isinstance(value, dict):
        found.setdefault(path, []).append(list(value))
        for key, entry in value.items():
            collect(entry, f"{path}.{key}".lstrip("."), found)


def rows_of(page):
    """First and second column of the section's tables: rows of paths, and shapes by their names."""
    section = page.read_text().split("## Report (JSON)")[1].split("\n## ")[0]
    rows, shapes = {}, []
    for line in section.splitlines():
        cells = [cell.strip() for cell in line.strip("|").split(" | ")]
        if not line.startswith("| ") or len(cells) < 2:
            continue
        keys = re.findall(r"`([^`]+)`", cells[1])
        if cells[0] == "the report":
            rows[""] = keys
        elif re.fullmatch(r"`[\w.\[\]]+`", cells[0]):
            rows[cells[0].strip("`")] = keys
        elif keys:
            shapes.append(keys)
    return rows, shapes


def row_for(path, rows):
    parts = path.split(".")
    tails = (".".join(parts[i:]) for i in range(len(parts)))
    return next((rows[tail] for tail in tails if tail in rows), None)


def faults(found, rows, shapes):
    for path, lists in found.items():
        if all(keys in shapes for keys in lists):
            continue
        told, name = row_for(path, rows), path or "the report"
        if told is None:
            yield f"{name}: no row, and it has {', '.join(lists[0])}"
            continue
        for keys in lists:
            if [key for key in told if key in keys] != keys:
                yield f"{name}: the report has {', '.join(keys)}; the page has {', '.join(told)}"
        for key in sorted(set(told) - RARE - {key for keys in lists for key in keys}):
            if path in rows:
                yield f"{name}: no report has {key}"
    for path in sorted(set(rows) - set(found)):
        yield f"{path}: no report has it"


def main():
    command, project = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2])
    page = project / "docs" / "file_format.md"
    rows, shapes = rows_of(page)
    if not FILLER:
        del rows["core_fill"]
    schema = json.loads((project / "docs" / "schema" / "report.schema.json").read_text())
    found, against_schema = {}, []
    with tempfile.TemporaryDirectory() as folder:
        for report in reports(command, project.resolve() / "samples" / "meshes", pathlib.Path(folder)):
            collect(report, "", found)
            against_schema += json_schema.all_faults(report, schema)
    if not json_schema.all_faults({**report, "side": 1}, schema):
        against_schema.append("the schema allows a side that is a number")
    if f"the number of this form, {report['schema']}, " not in page.read_text():
        against_schema.append(f"the page does not say that the report's schema is {report['schema']}")
    wrong = list(dict.fromkeys([*faults(found, rows, shapes), *against_schema]))
    print("\n".join(wrong) or f"{sum(map(len, rows.values()))} keys of {len(rows)} objects are as the page has them")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
